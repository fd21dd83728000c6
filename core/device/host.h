#pragma once

#include "core/device/backend.h"
#include "core/device/team.h"

#include <boost/align/aligned_allocator.hpp>

#include <vector>

namespace tetrace {

/// The machine's processor as a device: model name, largest cache, and memory or a container's limit of it; the caller
/// adds driver and threads.
[[nodiscard]] Device host_device();

/// Whether the processor runs code compiled for x86-64-v3 (AVX2 and fused multiply-add); true on other architectures,
/// whose baseline has fused instructions.
[[nodiscard]] bool host_has_fused_multiply();

/// A session on threads of the host's own processor: launch() runs its jobs to the end, and wait() returns how long
/// that took. A backend implements run() and the set-up.
class HostSession : public Session {
public:
    HostSession(Task task, unsigned threads) : task_(task), threads_(threads) {}
    [[nodiscard]] double wait() final { return kernel_s_; }

private:
    void start(std::span<const TraceJob> jobs) final;
    void read_output(std::span<std::uint32_t> words) final;
    /// Traces what this thread takes of the image's tiles; each thread calls it. output: of the whole image,
    /// words_per_ray() per ray, row after row; then the words of the tally.
    virtual void run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles) = 0;

    Task task_;
    unsigned threads_;
    /// The first hit, after the guard, starts a cache line, as the first guard does.
    std::vector<std::uint32_t, boost::alignment::aligned_allocator<std::uint32_t, 64>> output_;
    double kernel_s_ = 0;
};

/// A hit is six words without padding: an output of task trace holds hits, as on every device.
[[nodiscard]] inline std::span<Hit> as_hits(std::span<std::uint32_t> output)
{
    return {reinterpret_cast<Hit*>(output.data()), output.size() / HIT_WORDS};
}

} // namespace tetrace
