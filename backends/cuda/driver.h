#pragma once

#include <cstddef>
#include <string>

namespace tetrace::cuda {

// The driver API's types as its binary interface has them: no CUDA header is needed to build this backend.
using Result = int;                 ///< CUresult
using Ordinal = int;                ///< CUdevice
using Address = unsigned long long; ///< CUdeviceptr
using ContextHandle = struct ContextState*;
using ModuleHandle = struct ModuleState*;
using FunctionHandle = struct FunctionState*;
using StreamHandle = struct StreamState*;
using EventHandle = struct EventState*;

// CUresult values that are distinguished.
constexpr Result success = 0;
constexpr Result error_invalid_value = 1;
constexpr Result error_out_of_memory = 2;
constexpr Result error_invalid_image = 200;
constexpr Result error_unsupported_ptx = 222;
constexpr Result error_not_found = 500;
constexpr Result error_launch_resources = 701;
constexpr Result error_launch_failed = 719;
constexpr Result error_not_supported = 801;

// CUdevice_attribute values that are queried.
constexpr int attribute_block_threads = 1;
constexpr int attribute_warp_size = 10;
constexpr int attribute_multiprocessors = 16;
constexpr int attribute_l2_bytes = 38;
constexpr int attribute_capability_major = 75;
constexpr int attribute_capability_minor = 76;

/// The driver as a table of functions: NVIDIA's library, or host functions that replace it (backends/cuda_host). The
/// rest of this backend uses CUDA only through such a table.
struct Driver {
#define DRIVER_FUNCTION(member, symbol, parameters, arguments) Result(*member) parameters = nullptr;
#include "backends/cuda/driver_functions.inc"
#undef DRIVER_FUNCTION
    /// Not part of CUDA: only an emulation has it, which shows that devices are emulated. Sets the number of host
    /// threads for the calling thread's next launches.
    void (*use_threads)(unsigned threads) = nullptr;

    [[nodiscard]] bool is_emulation() const
    {
        return use_threads != nullptr;
    }
};

/// The name under which an emulation exports Driver::use_threads.
constexpr const char* use_threads_symbol = "tetrace_emulation_use_threads";

/// The result of looking for a driver: a complete table, or the reason why it cannot be used.
struct LoadedDriver {
    Driver driver;
    std::string reason;       ///< empty if it can be used; else what is wrong and what to install
    std::string library = {}; ///< Device::library

    [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Loads a driver's library, which stays loaded, and starts it (cuInit).
/// library: a file, or a name that the system's loader finds: "libcuda.so.1".
[[nodiscard]] LoadedDriver load_driver(const char* library);

/// A result in words: "CUDA_ERROR_ILLEGAL_ADDRESS (an illegal memory access was encountered)".
[[nodiscard]] std::string text_of(const Driver& driver, Result result);

/// A driver's version as text: 13000 as "13.0".
[[nodiscard]] std::string version_text(int version);

} // namespace tetrace::cuda
