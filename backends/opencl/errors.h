#pragma once

#include "backends/opencl/api.h"
#include "core/base/error.h"

#include <cstdint>
#include <string>

namespace tetrace::opencl {

/// "CL_OUT_OF_RESOURCES"; "OpenCL error -9999" if OpenCL 1.2 and its loader do not name it.
[[nodiscard]] std::string error_name(cl_int code);

/// Whether the code means that memory or a limit on buffers is too small.
[[nodiscard]] bool is_about_memory(cl_int code);

/// What was being done when the API failed, for the error's text.
struct Doing {
    std::string doing;              ///< "launching cdt/maria/tet80"
    std::string device;             ///< its name
    std::uint64_t bytes = 0;        ///< that the session holds or asks for on the device
    std::uint64_t memory_bytes = 0; ///< of the device
};

/// unsupported with both numbers where memory does not suffice, else internal; both name call, code and device.
[[nodiscard]] Error to_error(const cl::Error& failure, const Doing& task);

} // namespace tetrace::opencl
