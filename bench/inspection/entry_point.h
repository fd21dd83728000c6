#pragma once

#include "bench/inspection/target.h"
#include "bench/options/options.h"
#include "core/pack/kernel_id.h"

#include <string>
#include <vector>

namespace tetrace {

/// An entry point of a kernel. The kernel's task and schedule are the entry's.
struct EntryPoint {
    KernelId kernel;
    Entry entry = Entry::outside;
};

/// Every entry point of our kernels that the maker's GPUs get, in the kernels' order. AMD's have no schedule
/// persistent: Vulkan has no such kernels.
[[nodiscard]] std::vector<EntryPoint> all_entry_points(Maker maker);

/// Whether --structure, --method, --layout, --schedule, --math and --entry keep it. Defaults: as for rows, and math
/// mode exact.
[[nodiscard]] bool wants(const Options& options, const EntryPoint& point);

/// "outside", "rays", "inside persistent".
[[nodiscard]] std::string name_of(const EntryPoint& point);

} // namespace tetrace
