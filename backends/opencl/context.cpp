#include "backends/opencl/context.h"

#include <array>
#include <vector>

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

double seconds_between(const cl::Event& first, const cl::Event& last)
{
    return 1e-9 * static_cast<double>(last.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                      first.getProfilingInfo<CL_PROFILING_COMMAND_START>());
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
