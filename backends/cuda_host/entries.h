#pragma once

// The entry points of KERNEL_FILE, the text of a kernel from backends/cuda/kernel.cu, as the emulated driver calls
// them. KERNEL_NAME is method_layout_math. kernel.cpp compiles it; flattened, it is also the frame of a text that is
// compiled where the program runs (backend.cpp).
#include "backends/cuda_host/kernels.h"

namespace {
#include KERNEL_FILE

#ifdef SET_ENTRY
// What a block may have at most: no launch asks for more.
thread_local uint group_words[STACK_ENTRY_WORDS * STACK_TOP * tetrace::cuda_host::max_block_threads];
#endif
} // namespace

namespace tetrace::cuda_host {

#define HOST_ENTRY(kernel)                                                                                             \
    extern "C" void ENTRY(run_##kernel, KERNEL_NAME)(const Place& place, void** arguments)                             \
    {                                                                                                                  \
        call(ENTRY(kernel, KERNEL_NAME), place, arguments);                                                            \
    }

HOST_ENTRY(trace_tiles_)
HOST_ENTRY(trace_persistent_)

#ifdef STARTS_IN_TETS
HOST_ENTRY(inside_tiles_)
HOST_ENTRY(inside_persistent_)
#endif

#ifdef TAKES_RAYS
HOST_ENTRY(rays_tiles_)
HOST_ENTRY(rays_persistent_)
#endif

#ifdef CROSSES_TETS
#define CROSSING_TASK(name, ...) HOST_ENTRY(name##_tiles_)
#include "kernels/kernel_list.inc"
#endif

#ifdef SEARCHES_EXITS
HOST_ENTRY(search_tiles_)
#endif

} // namespace tetrace::cuda_host
