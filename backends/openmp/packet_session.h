#pragma once

#include "backends/openmp/packets.h"
#include "core/device/host_session.h"

#include <memory>
#include <vector>

namespace tetrace::openmp {

/// A width that packets are compiled for, and their kernel.
struct PacketKernel {
    unsigned lanes;
    TracePackets* block;
    TracePackets* rays;
};
/// The widths that this build has and this processor runs, the widest first; never empty.
[[nodiscard]] const std::vector<PacketKernel>& packet_kernels();
/// The kernel with that many lanes; 0: the widest. Throws Error{unsupported}, which says why it is missing and which
/// widths there are.
[[nodiscard]] PacketKernel packet_kernel(unsigned lanes);

/// Schedule packets: traces packets of primary or given rays through layout half32. Hits are the same bits as with
/// schedule tiles.
class PacketSession : public HostSession {
public:
    PacketSession(PacketKernel kernel, Task task, const PackedScene& scene, unsigned threads);
    void set_rays(std::span<const Quad> quads) override;
    [[nodiscard]] SetupTimes setup_times() const override;
    [[nodiscard]] std::uint64_t bytes() const override { return scene_.bytes(); }

private:
    struct Free {
        void operator()(void* block) const { std::free(block); }
    };

    void run(const TraceJob& job, std::span<std::uint32_t> output) override;

    PacketKernel kernel_;
    Task task_;
    const PackedScene& scene_;
    unsigned threads_;
    double copy_s_ = 0;
    std::vector<Quad> rays_;
    bool rays_end_ = false;                        ///< any of them
    bool rays_start_outside_ = false;              ///< any of them
    std::unique_ptr<std::uint32_t, Free> records_; ///< aligned so that no record crosses a cache line, on huge pages
};

} // namespace tetrace::openmp
