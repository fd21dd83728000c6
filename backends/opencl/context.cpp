#include "backends/opencl/context.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tetrace::opencl {

namespace {

/// The part of a device with that many compute units; the whole device if it cannot be divided so.
cl::Device part_of(cl::Device device, unsigned units)
{
    const std::array<cl_device_partition_property, 4> by_counts = {CL_DEVICE_PARTITION_BY_COUNTS,
                                                                   static_cast<cl_device_partition_property>(units),
                                                                   CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    try {
        device.createSubDevices(by_counts.data(), &parts);
    } catch (const cl::Error&) {
        return device;
    }
    return parts.empty() ? device : parts.front();
}

} // namespace

double seconds_of(const std::vector<cl::Event>& commands)
{
    cl_ulong begin = std::numeric_limits<cl_ulong>::max(), end = 0;
    for (const cl::Event& command : commands) {
        begin = std::min(begin, command.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        end = std::max(end, command.getProfilingInfo<CL_PROFILING_COMMAND_END>());
    }
    return 1e-9 * static_cast<double>(end - begin);
}

Context::Context(const FoundDevice& found, unsigned threads)
    : found_(found), device_(found.id, true), threads_(found.facts.threads)
{
    run("making a context", 0, [&] {
        if (found.facts.kind == DeviceKind::emulated && threads != 0 && threads < threads_) {
            device_ = part_of(device_, threads);
            threads_ = device_.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
        }
        handle_ = cl::Context(device_);
    });
}

} // namespace tetrace::opencl
