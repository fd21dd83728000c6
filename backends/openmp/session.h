#pragma once

#include "backends/openmp/kernels.h"
#include "core/host_session.h"

namespace tetrace::openmp {

/// Runs one compiled kernel on the packed scene where it lies: nothing is compiled, nothing copied.
class OpenmpSession : public HostSession {
public:
    OpenmpSession(TraceFunction kernel, const PackedScene& scene, unsigned threads, unsigned tile_height);
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override { return scene_.bytes(); }

private:
    void trace(const TraceJob& job, std::span<Hit> hits) override;

    TraceFunction kernel_;
    const PackedScene& scene_;
    unsigned threads_, tile_height_;
};

} // namespace tetrace::openmp
