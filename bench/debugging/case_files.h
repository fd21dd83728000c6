#pragma once

#include "bench/options/options.h"
#include "core/device/backend.h"

#include <vector>

namespace tetrace {

/// A launch and what it should write, for those who do not have tetrace.
struct DumpedCase {
    std::string title;
    std::vector<KernelFile> files; ///< case.h, all that it names, and a host that runs it
};

/// The case of --defect; or of --scene: one_kernel() on the tile of --pixel, whose output is openmp's. It is as the
/// first device that matches --device gets it, or without one as a GPU does.
/// Throws Error{usage} if the backend of --backend has no host for cases, or the kernel is not ours or not of math mode
/// exact; Error{missing} if no device matches; what rows_of_ray(), ray_of() and loading the scene throw.
[[nodiscard]] DumpedCase dumped_case(const Options& options, const std::vector<Backend*>& backends);

} // namespace tetrace
