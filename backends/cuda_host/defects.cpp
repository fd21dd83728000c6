// backends/cuda/defects.cu as host C++.
#include "backends/cuda_host/kernels.h"
#include "kernels/layouts/defect_words.h"
#include "kernels/layouts/layout.h"

#include <thread>

// Of a kernel with barriers, the first thread of a block runs all of it: each thread in turn, between barriers.
#define EACH_ITEM for (threadIdx.x = 0u; threadIdx.x < blockDim.x; threadIdx.x++)
#define PAUSE std::this_thread::yield();

namespace {

void __syncthreads() {}

void __threadfence()
{
    std::atomic_thread_fence(std::memory_order_seq_cst);
}

std::uint32_t __activemask()
{
    return 1;
}

#include "backends/cuda/defects.cu"
} // namespace

namespace tetrace::cuda_host {

#define DEFECT(name)                                                                                                   \
    extern "C" void run_run_##name(const Place& place, void** arguments)                                               \
    {                                                                                                                  \
        call(run_##name, place, arguments);                                                                            \
    }
#define GROUP_DEFECT(name)                                                                                             \
    extern "C" void run_run_##name(const Place& place, void** arguments)                                               \
    {                                                                                                                  \
        if (place.thread.x == 0u) call(run_##name, place, arguments);                                                  \
    }
#define LANE_DEFECT GROUP_DEFECT
#define FAR_DEFECT GROUP_DEFECT
#include "kernels/defects/defect_list.inc"

} // namespace tetrace::cuda_host
