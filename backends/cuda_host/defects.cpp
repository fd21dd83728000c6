// backends/cuda/defects.cu as host C++.
#include "backends/cuda_host/kernels.h"
#include "backends/cuda_host/shim.h"
#include "kernels/layouts/layout.h"

namespace {
#include "backends/cuda/defects.cu"
} // namespace

namespace tetrace::cuda_host {

#define DEFECT(name)                                                                                                   \
    void run_run_##name(void** arguments)                                                                              \
    {                                                                                                                  \
        call(run_##name, arguments);                                                                                   \
    }
#include "kernels/defects/defect_list.inc"

} // namespace tetrace::cuda_host
