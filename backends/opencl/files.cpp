#include "backends/opencl/files.h"

#include "backends/opencl/kernels.h"
#include "backends/opencl/program.h"

namespace tetrace::opencl {

std::vector<KernelFile> kernel_files(const KernelId& kernel)
{
    const std::string name = source_name(kernel);
    const EmbeddedKernel* const source = find_kernel(embedded_kernels(), name);
    if (source == nullptr || name == "probe") return {};
    const std::string options = "-cl-std=CL1.2 -DGROUP_ITEMS=64" + std::string(math_options(kernel.math));
    std::string what =
        "OpenCL C with its includes resolved, as the driver's compiler gets it; the kernel is run_image. "
        "clBuildProgram gets '" +
        options + "', and also: ";
    if (kernel.structure == Structure::cdt) what += "-DSTARTS_OUTSIDE for rays from outside; ";
    what += "-DRAYS for given rays; -DSEARCH for single exit searches; -DPERSISTENT for that schedule; "
            "-cl-denorms-are-zero on processors; -cl-fp32-correctly-rounded-divide-sqrt where the device offers it";
    return {{name + ".cl", what,
             "clang -x cl -Xclang -finclude-default-header -fsyntax-only " + options + " " + name + ".cl",
             std::string(source->text())}};
}

} // namespace tetrace::opencl
