#pragma once

#include "core/mesh/scene.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// Of each pixel, the tet at its point of the cut: the plane through the middle of the domain's box, across the line of
/// sight. NO_TET where the plane is outside the domain. Row after row.
/// Throws Error{usage} if the middle of the box is not in front of the camera.
[[nodiscard]] std::vector<std::uint32_t> tets_on_cut(const Scene& scene, const View& view, std::uint32_t width,
                                                     std::uint32_t height);

/// The sum of each tet of the cut over its volume, in percent of the sum of all over the volume of all, as whole
/// numbers in the place of hits' steps. tets: as tets_on_cut() has them. sums: lengths per tet, in the mesh's order;
/// volumes: per tet, in any unit.
[[nodiscard]] std::vector<Hit> tally_at_pixels(std::span<const std::uint32_t> tets, std::span<const std::uint64_t> sums,
                                               std::span<const double> volumes);

} // namespace tetrace
