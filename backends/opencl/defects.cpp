#include "backends/opencl/defects.h"

#include "backends/opencl/program.h"
#include "core/debugging/defects.h"

namespace tetrace::opencl {

std::vector<std::uint32_t> run_defect(Context& context, std::string_view name)
{
    std::vector<std::uint32_t> results(defect_items);
    const auto words = defect_words();
    const ProgramCache none({});
    const Program program(context, {"defects"}, none);
    const std::size_t read_bytes = words.size() * sizeof(words[0]), written_bytes = results.size() * sizeof(results[0]);
    context.run("running " + std::string(name), read_bytes + written_bytes, [&] {
        const cl::CommandQueue queue = context.make_queue();
        const cl::Buffer from(context.handle(), CL_MEM_READ_ONLY, read_bytes);
        const cl::Buffer to(context.handle(), CL_MEM_READ_WRITE, written_bytes);
        queue.enqueueWriteBuffer(from, CL_TRUE, 0, read_bytes, words.data());
        cl::Kernel kernel(program.handle(), ("run_" + std::string(name)).c_str());
        kernel.setArg(0, from);
        kernel.setArg(1, to);
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(defect_items), cl::NDRange(defect_items));
        queue.enqueueReadBuffer(to, CL_TRUE, 0, written_bytes, results.data());
    });
    return results;
}

} // namespace tetrace::opencl
