#include "backends/opencl/code.h"

#include "backends/opencl/program.h"
#include "core/device/session.h"

namespace tetrace::opencl {

namespace {

ProgramId program_of(const Context& context, const std::optional<KernelId>& kernel, bool starts_outside)
{
    ProgramId id{"probe"};
    if (kernel)
        id = {source_name(*kernel), kernel->math,
              defines_of(*kernel, tile_height_of({}), false, starts_outside && kernel->structure == Structure::cdt,
                         context.found().stack_top)};
    if (context.device().getInfo<CL_DEVICE_EXTENSIONS>().find("cl_nv_compiler_options") != std::string::npos)
        id.defines += " -cl-nv-verbose";
    return id;
}

} // namespace

CompiledCode compiled_code(Context& context, const std::optional<KernelId>& kernel, bool starts_outside)
{
    const ProgramId id =
        context.run("asking for extensions", 0, [&] { return program_of(context, kernel, starts_outside); });
    const ProgramCache none({});
    const Program program(context, id, none);
    CompiledCode code{context.facts().driver + ", " + context.facts().name, context.facts().group_width, {}, {}, {}};
    context.run("asking about " + id.source, 0, [&] {
        const cl::Kernel made(program.handle(), kernel ? "run_image" : "run_probe");
        const cl::Device& device = context.device();
        const auto set = [&](const char* name, auto value) { code.statistics[name] = static_cast<double>(value); };
        set("WORK_GROUP_SIZE", made.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device));
        set("LOCAL_MEM_SIZE", made.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device));
        set("PRIVATE_MEM_SIZE", made.getWorkGroupInfo<CL_KERNEL_PRIVATE_MEM_SIZE>(device));
        set("PREFERRED_WORK_GROUP_SIZE_MULTIPLE",
            made.getWorkGroupInfo<CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE>(device));
        code.messages = program.handle().getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    });
    return code;
}

} // namespace tetrace::opencl
