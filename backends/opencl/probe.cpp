#include "backends/opencl/probe.h"

#include "backends/opencl/program.h"

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

} // namespace tetrace::opencl
