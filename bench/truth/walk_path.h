#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// The tets that the walk of one pixel leaves, in order, as positions in the packed scene, at most so many; traced by
/// the device that the session is on. Throws what the session throws.
[[nodiscard]] std::vector<std::uint32_t> walk_path(Session& session, const TraceJob& job, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t most);

/// The same, all of it, traced by the openmp backend.
[[nodiscard]] std::vector<std::uint32_t> walk_path(const PackedScene& packed, const KernelId& kernel,
                                                   const TraceJob& job, std::uint32_t x, std::uint32_t y);

} // namespace tetrace
