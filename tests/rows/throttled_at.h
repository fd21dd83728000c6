#pragma once

#include "bench/measuring/gpu_monitor.h"

namespace tetrace::test {

/// A GPU that is throttled at some of the readings.
class ThrottledAt : public GpuMonitor {
public:
    ThrottledAt(int& asked, int first, int last) : asked_(&asked), first_(first), last_(last) {}
    [[nodiscard]] GpuState read() override
    {
        const bool is_throttled = *asked_ >= first_ && *asked_ <= last_;
        ++*asked_;
        return {1500, {}, {}, {}, is_throttled ? "heat" : ""};
    }

private:
    int* asked_;
    int first_, last_;
};

} // namespace tetrace::test
