#pragma once

#include "core/backend.h"

#include <vector>

namespace tetrace {

/// A session on the host's own processor and memory: launch() traces to the end, wait() tells how long that took.
/// A backend brings trace(), and what was set up.
class HostSession : public Session {
public:
    void launch(const TraceJob& job) final;
    [[nodiscard]] double wait() final { return kernel_s_; }

private:
    void read_output(std::span<std::uint32_t> words) final;
    /// Traces the whole image into hits, row after row.
    virtual void trace(const TraceJob& job, std::span<Hit> hits) = 0;

    std::vector<std::uint32_t> output_;
    double kernel_s_ = 0;
};

} // namespace tetrace
