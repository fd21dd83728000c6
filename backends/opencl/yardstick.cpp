#include "backends/opencl/yardstick.h"

#include "backends/opencl/program.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace tetrace::opencl {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{128} << 20;
constexpr int passes = 6;
constexpr int launches = 51;

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
    std::vector<double> seconds;
    for (int i = 0; i < launches; ++i) {
        const auto start = std::chrono::steady_clock::now();
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1));
        queue.finish();
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(seconds.begin(), seconds.begin() + launches / 2, seconds.end());
    return seconds[launches / 2];
}

} // namespace

Yardstick measure_device(Context& context, std::uint64_t max_buffer_bytes)
{
    const ProgramCache none({});
    const Program program(context, {"probe"}, none);
    const std::uint64_t bytes = std::min({most_bytes, max_buffer_bytes, context.facts().memory_bytes / 4}) & ~3ull;
    return context.run("measuring the device", 2 * bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Kernel nothing(program.handle(), "do_nothing");
        return Yardstick{copy_bytes_per_s(context, queue, bytes), launch_s(queue, nothing)};
    });
}

} // namespace tetrace::opencl
