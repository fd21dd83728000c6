#pragma once

#include "backends/openmp/kernels.h"
#include "core/backend.h"

namespace tetrace::openmp {

/// Runs one kernel on the host's memory: nothing is compiled, nothing copied; launch() traces, wait() tells how long it
/// took.
class OpenmpSession : public Session {
public:
    OpenmpSession(TraceFunction trace, const PackedScene& scene, unsigned threads);
    void launch(const TraceJob& job) override;
    [[nodiscard]] double wait() override;
    void read_back(std::span<Hit> hits) override;
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override;

private:
    TraceFunction trace_;
    const PackedScene& scene_;
    unsigned threads_;
    std::vector<Hit> hits_;
    double kernel_s_ = 0;
};

} // namespace tetrace::openmp
