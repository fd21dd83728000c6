#pragma once

#include "backends/openmp/kernels.h"
#include "core/device/host.h"

namespace tetrace::openmp {

/// Runs one compiled kernel on the packed scene in place: nothing is compiled, and only given rays are copied.
class OpenmpSession : public HostSession {
public:
    OpenmpSession(RunFunction* function, Task task, const PackedScene& scene, unsigned threads, unsigned tile_height)
        : HostSession(task, threads), run_(function), scene_(scene), tile_height_(tile_height)
    {
        make_tally(task, scene.tet_count);
    }
    void set_rays(std::span<const Quad> quads) override { rays_.assign(quads.begin(), quads.end()); }
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override { return scene_.bytes(); }

private:
    void run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles) override
    {
        run_(scene_, rays_, job, output, tiles, tile_height_);
    }

    RunFunction* run_;
    const PackedScene& scene_;
    std::vector<Quad> rays_;
    unsigned tile_height_;
};

} // namespace tetrace::openmp
