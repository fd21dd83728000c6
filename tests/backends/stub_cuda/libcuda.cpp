// A library that poses as NVIDIA's driver: the host emulation under the real names, so that the cuda backend runs from
// its library's loading to its last hit on a machine without a GPU. TETRACE_STUB_FAIL makes it fail where drivers do:
//   alloc   no memory is left             module  a module's assembly is newer than the driver
//   launch  a kernel cannot be launched   lost    a kernel fails, and with it all that follows until the context's last
//   session has released it
//   crash   the driver aborts at its start crash-launch  the driver aborts at a launch
#include "backends/cuda_host/driver.h"

#include <array>
#include <cstdlib>
#include <string_view>

using namespace tetrace::cuda;

namespace {

bool context_is_lost = false;
int sessions = 0; // that have retained the context

bool asked_for(std::string_view failure)
{
    const char* asked = std::getenv("TETRACE_STUB_FAIL");
    return asked != nullptr && asked == failure;
}

/// Calls that a lost context answers with its error; what only gives something back is done all the same.
bool needs_context(std::string_view symbol)
{
    constexpr std::array work{"cuModuleLoadDataEx",   "cuModuleGetFunction", "cuMemAlloc_v2",  "cuMemcpyHtoDAsync_v2",
                              "cuMemcpyDtoHAsync_v2", "cuMemsetD32Async",    "cuStreamCreate", "cuStreamSynchronize",
                              "cuStreamWaitEvent",    "cuEventCreate",       "cuEventRecord",  "cuEventSynchronize",
                              "cuLaunchKernel"};
    for (const char* name : work)
        if (symbol == name) return true;
    return false;
}

Result failure_of(std::string_view symbol)
{
    if (symbol == "cuInit" && asked_for("crash")) std::abort();
    if (symbol == "cuLaunchKernel" && asked_for("crash-launch")) std::abort();
    if (symbol == "cuDevicePrimaryCtxRetain") ++sessions;
    if (symbol == "cuDevicePrimaryCtxRelease_v2" && --sessions == 0) context_is_lost = false;
    if (context_is_lost && needs_context(symbol)) return error_launch_failed;
    if (symbol == "cuMemAlloc_v2" && asked_for("alloc")) return error_out_of_memory;
    if (symbol == "cuModuleLoadDataEx" && asked_for("module")) return error_unsupported_ptx;
    if (symbol == "cuLaunchKernel" && asked_for("launch")) return error_launch_resources;
    // The launch itself succeeds, as on a GPU: who waits for it learns what came of it.
    if (symbol == "cuLaunchKernel" && asked_for("lost")) context_is_lost = true;
    return success;
}

} // namespace

#define DRIVER_FUNCTION(member, symbol, parameters, arguments)                                                         \
    extern "C" __attribute__((visibility("default"))) Result symbol parameters                                         \
    {                                                                                                                  \
        if (const Result failure = failure_of(#symbol); failure != success) return failure;                            \
        return tetrace::cuda_host::emulated_driver().member arguments;                                                 \
    }
#include "backends/cuda/driver_functions.inc"
#undef DRIVER_FUNCTION

extern "C" __attribute__((visibility("default"))) void tetrace_emulation_use_threads(unsigned threads)
{
    tetrace::cuda_host::emulated_driver().use_threads(threads);
}

// NVRTC asks a driver that is loaded for tables of functions, of which this one has none: each is as long as its first
// word says. (NVRTC 13.0 does not ask whether there is a table at all.)
extern "C" __attribute__((visibility("default"))) Result cuGetExportTable(const void** table, const void*)
{
    static const std::size_t empty[] = {sizeof(std::size_t)};
    *table = empty;
    return error_not_found;
}
