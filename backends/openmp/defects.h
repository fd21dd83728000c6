#pragma once

#include "core/device/defects.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace::openmp {

/// Runs a reduced kernel or a stressor, as the compiler of this build made it; groups that share memory run at once.
/// Returns its output. Throws Error{internal} if there is none of that name.
[[nodiscard]] std::vector<std::uint32_t> words_of_defect(std::string_view name, const DefectLaunch& launch);

} // namespace tetrace::openmp
