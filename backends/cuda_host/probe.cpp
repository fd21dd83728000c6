// backends/cuda/probe.cu as host C++: compiled once per math mode (CMakeLists.txt), which is given by KERNEL_NAME.
#include "backends/cuda_host/kernels.h"
#include "kernels/layouts/layout.h"

namespace {
#include "backends/cuda/probe.cu"

#define JOINED(prefix, name) prefix##name
#define ENTRY(prefix, name) JOINED(prefix, name)
} // namespace

namespace tetrace::cuda_host {

extern "C" void ENTRY(run_, KERNEL_NAME)(const Place& place, void** arguments)
{
    call(KERNEL_NAME, place, arguments);
}

} // namespace tetrace::cuda_host
