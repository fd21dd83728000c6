#pragma once

#include "backends/embree/accelerator.h"
#include "core/host_session.h"

#include <memory>

namespace tetrace::embree {

/// Primary rays through Embree, in the same tiles and from the same bits as the walk's.
class EmbreeSession : public HostSession {
public:
    EmbreeSession(Method method, std::shared_ptr<const Accelerator> accelerator, unsigned threads);
    [[nodiscard]] SetupTimes setup_times() const override { return {accelerator_->build_s(), 0.0, false}; }
    [[nodiscard]] std::uint64_t bytes() const override { return accelerator_->bytes(); }

private:
    void run(const TraceJob& job, std::span<std::uint32_t> output) override;

    Method method_;
    std::shared_ptr<const Accelerator> accelerator_;
    unsigned threads_;
};

/// Traces a whole image into hits, row after row.
void trace_image(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<Hit> hits,
                 unsigned threads);

} // namespace tetrace::embree
