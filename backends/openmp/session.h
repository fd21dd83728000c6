#pragma once

#include "backends/openmp/kernels.h"
#include "core/device/host_session.h"

namespace tetrace::openmp {

/// Runs one compiled kernel on the packed scene where it lies: nothing is compiled, nothing but given rays copied.
class OpenmpSession : public HostSession {
public:
    OpenmpSession(RunFunction* function, Task task, const PackedScene& scene, unsigned threads, unsigned tile_height);
    void set_rays(std::span<const Row> rows) override { rays_.assign(rows.begin(), rows.end()); }
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override { return scene_.bytes(); }

private:
    void run(const TraceJob& job, std::span<std::uint32_t> output) override;

    RunFunction* run_;
    const PackedScene& scene_;
    std::vector<Row> rays_;
    unsigned threads_, tile_height_;
};

} // namespace tetrace::openmp
