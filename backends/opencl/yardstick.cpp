#include "backends/opencl/yardstick.h"

#include "backends/opencl/program.h"
#include "core/device/yardstick.h"

namespace tetrace::opencl {

namespace {

Yardstick measured_copies(Context& context, const cl::CommandQueue& queue, std::uint64_t bytes)
{
    const cl::Buffer from(context.handle(), CL_MEM_READ_WRITE, bytes), to(context.handle(), CL_MEM_READ_WRITE, bytes);
    queue.enqueueFillBuffer(from, cl_uint{1}, 0, bytes); // touched before they are timed
    queue.enqueueFillBuffer(to, cl_uint{2}, 0, bytes);
    return measure_copies(bytes, [&](std::uint64_t each, unsigned times) {
        cl::Event first, last;
        for (unsigned time = 0; time < times; ++time)
            queue.enqueueCopyBuffer(from, to, 0, 0, each, nullptr, time == 0 ? &first : &last);
        queue.finish();
        return seconds_of({first, times == 1 ? first : last});
    });
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
    const std::uint64_t bytes = copied_bytes(context.facts().memory_bytes, max_buffer_bytes);
    return context.run("measuring the device", 2 * bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Kernel nothing(program.handle(), "do_nothing");
        Yardstick measured = measured_copies(context, queue, bytes);
        measured.launch_s = launch_s(queue, nothing);
        return measured;
    });
}

} // namespace tetrace::opencl
