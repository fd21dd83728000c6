#include "backends/opencl/yardstick.h"

#include "backends/opencl/program.h"
#include "core/device/yardstick.h"

#include <algorithm>

namespace tetrace::opencl {

namespace {

constexpr int passes = 6;

double copy_bytes_per_s(Context& context, const cl::CommandQueue& queue, std::uint64_t bytes)
{
    const cl::Buffer from(context.handle(), CL_MEM_READ_WRITE, bytes), to(context.handle(), CL_MEM_READ_WRITE, bytes);
    queue.enqueueFillBuffer(from, cl_uint{1}, 0, bytes); // touched before they are timed
    queue.enqueueFillBuffer(to, cl_uint{2}, 0, bytes);
    double best_s = 1e300;
    for (int pass = 0; pass < passes; ++pass) {
        cl::Event event;
        queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &event);
        event.wait();
        best_s = std::min(best_s, seconds_of(event));
    }
    return best_s > 0 ? 2.0 * static_cast<double>(bytes) / best_s : 0;
}

double launch_s(const cl::CommandQueue& queue, const cl::Kernel& kernel)
{
    return median_seconds([&] {
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1));
        queue.finish();
    });
}

} // namespace

Yardstick measure_device(Context& context, std::uint64_t max_buffer_bytes)
{
    const ProgramCache none({});
    const Program program(context, {"probe"}, none);
    const std::uint64_t bytes = copied_bytes(context.facts(), max_buffer_bytes);
    return context.run("measuring the device", 2 * bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Kernel nothing(program.handle(), "do_nothing");
        return Yardstick{copy_bytes_per_s(context, queue, bytes), launch_s(queue, nothing)};
    });
}

} // namespace tetrace::opencl
