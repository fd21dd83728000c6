#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// The first tets that one pixel's walk leaves, in order, as positions in the packed scene, up to the given number. The
/// session's device traces the walk. Throws what the session throws.
[[nodiscard]] std::vector<std::uint32_t> walk_path(Session& session, const TraceJob& job, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t most);

/// The whole path, traced by the openmp backend.
[[nodiscard]] std::vector<std::uint32_t> walk_path(const PackedScene& packed, const KernelId& kernel,
                                                   const TraceJob& job, std::uint32_t x, std::uint32_t y);

} // namespace tetrace
