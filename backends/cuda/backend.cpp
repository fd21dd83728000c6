#include "backends/cuda/backend.h"

#include "backends/cuda/driver_backend.h"

namespace tetrace {

namespace cuda_sources {
std::span<const EmbeddedKernel> embedded_kernels(); // by tetrace_embed()
}
#ifdef TETRACE_CUDA_COMPILER
namespace cuda_code {
std::span<const EmbeddedKernel> embedded_kernels(); // by tetrace_embed()
}
#endif

namespace cuda {

std::span<const EmbeddedKernel> embedded_sources()
{
    return cuda_sources::embedded_kernels();
}

Programs embedded_programs()
{
    Programs programs;
    programs.sources = embedded_sources();
    programs.nvrtc = Nvrtc::installed;
#ifdef TETRACE_CUDA_COMPILER
    programs.code = cuda_code::embedded_kernels();
    programs.compiler = TETRACE_CUDA_COMPILER;
#endif
    return programs;
}

} // namespace cuda

Backend& cuda_backend()
{
    static cuda::DriverBackend backend(
        {"cuda", "CUDA events", [] { return cuda::load_driver("libcuda.so.1"); }, cuda::embedded_programs});
    return backend;
}

} // namespace tetrace
