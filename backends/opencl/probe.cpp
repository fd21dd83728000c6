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
    const Defect* const defect = find_defect(name);
    const bool shares = defect != nullptr && defect->expected_output != nullptr;
    ProgramId id{.source = "defects", .defines = (shares ? "-DGROUP_DEFECT=" : "-DDEFECT=") + std::string(name)};
    if (!shares || defect->need == DefectNeed::none) return id;
    if (defect->need == DefectNeed::ballots) id.defines += " -DLANES";
    if (defect->large_words != 0)
        id.defines += " -DLARGE";
    else
        id.standard = "CL3.0";
    return id;
}

namespace {

/// Throws Error{unsupported} if the device lacks what the kernel needs.
void require_for_defect(const FoundDevice& device, std::string_view name)
{
    const Defect* const defect = find_defect(name);
    if (defect == nullptr) return;
    if (defect->need == DefectNeed::ballots && !device.has_ballots)
        throw Error(ErrorKind::unsupported, "it lacks cl_khr_subgroup_ballot");
    if (defect->need == DefectNeed::fences && !device.has_fences)
        throw Error(ErrorKind::unsupported, "its OpenCL C 3.0 lacks fences between groups");
}

Program defect_on(Context& context, std::string_view name, const ProgramCache& cache)
{
    require_for_defect(context.found(), name);
    return {context, defect_program(name), cache};
}

} // namespace

DefectProgram::DefectProgram(std::shared_ptr<Context> context, std::string_view name)
    : context_(std::move(context)), name_(name), program_(defect_on(*context_, name, none_))
{
}

std::vector<std::uint32_t> DefectProgram::run(const DefectLaunch& launch) const
{
    std::vector<std::uint32_t> results(output_words(name_, launch));
    const auto words = defect_words(launch);
    const std::size_t read_bytes = words.size() * sizeof(words[0]), written_bytes = results.size() * sizeof(results[0]);
    Context& context = *context_;
    const std::uint64_t large_bytes = launch.large_bytes();
    context.run("running " + name_, read_bytes + written_bytes + large_bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Buffer from(context.handle(), CL_MEM_READ_ONLY, read_bytes);
        const cl::Buffer to(context.handle(), CL_MEM_READ_WRITE, written_bytes);
        queue.enqueueWriteBuffer(from, CL_TRUE, 0, read_bytes, words.data());
        queue.enqueueWriteBuffer(to, CL_TRUE, 0, written_bytes, results.data());
        cl::Kernel kernel(program_.handle(), "run_defect");
        kernel.setArg(0, from);
        kernel.setArg(1, to);
        kernel.setArg(2, launch.items);
        const cl::Buffer large =
            large_bytes == 0 ? cl::Buffer() : cl::Buffer(context.handle(), CL_MEM_READ_WRITE, large_bytes);
        if (large_bytes != 0) kernel.setArg(3, large);
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
