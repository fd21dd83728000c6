#pragma once

#include <string>

namespace tetrace::opencl {

/// Opens libOpenCL.so.1 at the first call, for as long as the process lives. Returns why it cannot be used, and what to
/// install; empty if it can. Before that, no function of the API may be called.
[[nodiscard]] const std::string& why_no_loader();

} // namespace tetrace::opencl
