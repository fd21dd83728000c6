#pragma once

#include "backends/embree/accelerator.h"
#include "core/backend.h"

#include <memory>

namespace tetrace::embree {

/// Primary rays through Embree, in the same tiles and from the same bits as the walk's.
class EmbreeSession : public Session {
public:
    EmbreeSession(Method method, std::shared_ptr<const Accelerator> accelerator, unsigned threads);
    void launch(const TraceJob& job) override;
    [[nodiscard]] double wait() override;
    void read_back(std::span<Hit> hits) override;
    [[nodiscard]] SetupTimes setup_times() const override { return {accelerator_->build_s(), 0.0}; }
    [[nodiscard]] std::uint64_t bytes() const override { return accelerator_->bytes(); }

private:
    Method method_;
    std::shared_ptr<const Accelerator> accelerator_;
    unsigned threads_;
    std::vector<Hit> hits_;
    double kernel_s_ = 0;
};

/// Traces a whole image into hits, row after row.
void trace_image(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<Hit> hits,
                 unsigned threads);

} // namespace tetrace::embree
