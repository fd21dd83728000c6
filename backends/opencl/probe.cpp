#include "backends/opencl/probe.h"

#include "core/device/defects.h"
#include "core/device/yardstick.h"

namespace tetrace::opencl {

std::vector<std::uint32_t> run_probe(Context& context, MathMode math, std::span<const Quad> operations)
{
    std::vector<std::uint32_t> results(operations.size());
    if (operations.empty()) return results;
    const ProgramCache none({});
    const Program program(context, {"probe", math}, none);
    const std::size_t result_bytes = results.size() * sizeof(results[0]);
    context.run("running the self-test", operations.size_bytes() + result_bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Buffer quads(context.handle(), CL_MEM_READ_ONLY, operations.size_bytes());
        const cl::Buffer words(context.handle(), CL_MEM_READ_WRITE, result_bytes);
        queue.enqueueWriteBuffer(quads, CL_TRUE, 0, operations.size_bytes(), operations.data());
        cl::Kernel kernel(program.handle(), "run_probe");
        kernel.setArg(0, quads);
        kernel.setArg(1, words);
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(operations.size()));
        queue.enqueueReadBuffer(words, CL_TRUE, 0, result_bytes, results.data());
    });
    return results;
}

ProgramId defect_program(std::string_view name)
{
    return {.source = "defects", .defines = "-DDEFECT=" + std::string(name)};
}

std::vector<std::uint32_t> run_defect(Context& context, std::string_view name, const DefectLaunch& launch)
{
    std::vector<std::uint32_t> results(launch.items);
    const auto words = defect_words();
    const ProgramCache none({});
    const Program program(context, defect_program(name), none);
    const std::size_t read_bytes = words.size() * sizeof(words[0]), written_bytes = results.size() * sizeof(results[0]);
    context.run("running " + std::string(name), read_bytes + written_bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Buffer from(context.handle(), CL_MEM_READ_ONLY, read_bytes);
        const cl::Buffer to(context.handle(), CL_MEM_READ_WRITE, written_bytes);
        queue.enqueueWriteBuffer(from, CL_TRUE, 0, read_bytes, words.data());
        cl::Kernel kernel(program.handle(), "run_defect");
        kernel.setArg(0, from);
        kernel.setArg(1, to);
        kernel.setArg(2, launch.items);
        const cl::NDRange group(launch.group_items), all(launch.groups() * launch.group_items);
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, all, group);
        queue.enqueueReadBuffer(to, CL_TRUE, 0, written_bytes, results.data());
    });
    return results;
}

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
