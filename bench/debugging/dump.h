#pragma once

#include "bench/options/options.h"
#include "bench/output/report.h"
#include "core/device/backend.h"

#include <vector>

namespace tetrace {

/// The one kernel of --method, --layout and --math, for primary rays in schedule tiles: the first of those that fit
/// that has rows by default, else the first. Throws Error{usage} if several methods, layouts or modes are named, or
/// no kernel fits.
[[nodiscard]] KernelId one_kernel(const Options& options);

/// The files of one_kernel() that the backend of --backend has, as its driver gets them.
/// Throws Error{usage} if the backend has none, with the reason.
[[nodiscard]] std::vector<KernelFile> dumped_files(const Options& options, const std::vector<Backend*>& backends);

/// The machine code of the kernel from the drivers of the backend's devices that report it. notes: gets a sentence for
/// each device that reports none. Loads the drivers, in this process.
[[nodiscard]] std::vector<KernelFile> driver_code(const Options& options, const std::vector<Backend*>& backends,
                                                  std::vector<std::string>& notes);

/// What dumped_files() are of.
[[nodiscard]] std::string dump_title(const Options& options);

/// The text of README.txt for these files, wrapped to `width` columns.
[[nodiscard]] std::string readme_of(const std::string& title, const std::vector<KernelFile>& files,
                                    const std::vector<std::string>& notes, std::size_t width = 110);

} // namespace tetrace
