#pragma once

#include "bench/options/options.h"

namespace tetrace {

/// The one kernel of --method, --layout and --math, for primary rays in schedule tiles: the first of those that fit
/// that has rows by default, else the first. Throws Error{usage} if several methods, layouts or modes are named, or
/// no kernel fits.
[[nodiscard]] KernelId one_kernel(const Options& options);

} // namespace tetrace
