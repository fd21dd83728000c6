#pragma once

#include "backends/embree/accelerator.h"
#include "core/device/host.h"

#include <memory>
#include <vector>

namespace tetrace::embree {

/// Rays through Embree: primary rays in the same tiles and with the same bits as the walk's, or given rays.
class EmbreeSession : public HostSession {
public:
    /// native_width: see Abilities.
    EmbreeSession(const KernelId& kernel, unsigned native_width, std::shared_ptr<const Accelerator> accelerator,
                  unsigned threads);
    void set_rays(std::span<const Quad> quads) override { rays_.assign(quads.begin(), quads.end()); }
    [[nodiscard]] SetupTimes setup_times() const override { return {accelerator_->build_s(), 0.0, false}; }
    [[nodiscard]] std::uint64_t bytes() const override { return accelerator_->bytes(); }

private:
    void run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles) override;

    KernelId kernel_;
    unsigned native_width_;
    std::vector<Quad> rays_;
    std::shared_ptr<const Accelerator> accelerator_;
};

/// Traces what this thread takes of an image's tiles. hits: of the whole image, row after row. native_width: see
/// Abilities.
void trace_image(const Accelerator& accelerator, Method method, unsigned native_width, const TraceJob& job,
                 std::span<Hit> hits, SharedTiles& shared);

} // namespace tetrace::embree
