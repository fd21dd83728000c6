#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace tetrace {

/// The job of only one pixel, an image of one ray: the same ray, bit for bit.
[[nodiscard]] TraceJob single_pixel(TraceJob job, std::uint32_t x, std::uint32_t y);

/// The first tets that a walk leaves, in order, as positions in the packed scene, up to the given number. A walk that
/// is cut off after k steps reports the tet that it was in. last: its hit without a cap of ours. trace: its hit with a
/// cap of steps. max_steps: no more are believed.
[[nodiscard]] std::vector<std::uint32_t> walk_path(const Hit& last, std::uint32_t max_steps,
                                                   const std::function<Hit(std::uint32_t cap)>& trace,
                                                   std::uint32_t most);

/// The first tets that one pixel's walk leaves, in order, as positions in the packed scene, up to the given number. The
/// session's device traces only the pixel. Throws what the session throws.
[[nodiscard]] std::vector<std::uint32_t> walk_path(Session& session, const TraceJob& job, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t most);

/// The whole path, traced by the openmp backend.
[[nodiscard]] std::vector<std::uint32_t> walk_path(const PackedScene& packed, const KernelId& kernel,
                                                   const TraceJob& job, std::uint32_t x, std::uint32_t y);

} // namespace tetrace
