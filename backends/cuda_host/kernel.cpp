// backends/cuda/kernel.cu as host C++: compiled once per kernel and math mode (CMakeLists.txt), which are given by
// macros: KERNEL_STRUCTURE_HEADER and the like, and KERNEL_NAME.
#include "backends/cuda_host/kernels.h"
#include "backends/cuda_host/shim.h"
#include "core/device/launch.h"
#include "kernels/layouts/layout.h"

namespace {
#include "backends/cuda/kernel.cu"

#ifdef SET_ENTRY
// What a block may have at most: no launch asks for more.
thread_local uint group_words[STACK_ENTRY_WORDS * STACK_TOP * tetrace::cuda_host::max_block_threads];
#endif
static_assert(sizeof(Hit) == sizeof(tetrace::Hit) && sizeof(LaunchParams) == sizeof(tetrace::LaunchParams));
} // namespace

namespace tetrace::cuda_host {

void ENTRY(run_trace_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(trace_tiles_, KERNEL_NAME), arguments);
}

void ENTRY(run_trace_persistent_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(trace_persistent_, KERNEL_NAME), arguments);
}

#ifdef STARTS_IN_TETS
void ENTRY(run_inside_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(inside_tiles_, KERNEL_NAME), arguments);
}

void ENTRY(run_inside_persistent_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(inside_persistent_, KERNEL_NAME), arguments);
}
#endif

#ifdef TAKES_RAYS
void ENTRY(run_rays_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(rays_tiles_, KERNEL_NAME), arguments);
}

void ENTRY(run_rays_persistent_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(rays_persistent_, KERNEL_NAME), arguments);
}
#endif

#ifdef CROSSES_TETS
void ENTRY(run_segments_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(segments_tiles_, KERNEL_NAME), arguments);
}

void ENTRY(run_tally_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(tally_tiles_, KERNEL_NAME), arguments);
}

void ENTRY(run_absorb_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(absorb_tiles_, KERNEL_NAME), arguments);
}
#endif

#ifdef SEARCHES_EXITS
void ENTRY(run_search_tiles_, KERNEL_NAME)(void** arguments)
{
    call(ENTRY(search_tiles_, KERNEL_NAME), arguments);
}
#endif

} // namespace tetrace::cuda_host
