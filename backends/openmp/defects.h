#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace::openmp {

/// Runs a reduced kernel (core/debugging/defects.h), as the compiler of this build made it. Throws Error{internal}
/// where there is none of that name.
[[nodiscard]] std::vector<std::uint32_t> run_defect(std::string_view name);

} // namespace tetrace::openmp
