// backends/cuda/kernel.cu as host C++: compiled once per kernel and math mode (CMakeLists.txt), which are given by
// macros: KERNEL_STRUCTURE_HEADER and the like, and KERNEL_NAME.
#include "core/device/launch.h"
#include "kernels/layouts/layout.h"

#define KERNEL_FILE "backends/cuda/kernel.cu"
#include "backends/cuda_host/entries.h"

static_assert(sizeof(Hit) == sizeof(tetrace::Hit) && sizeof(LaunchParams) == sizeof(tetrace::LaunchParams));
