#pragma once

#include "core/mesh/entry_grid.h"
#include "core/mesh/scene.h"

#include <string>

namespace tetrace {

/// Checks what docs/spec/project.md, P10, asks of the domain's sides, so that no ray sees a boundary face turned over:
/// the domain is in [-1, 1]^3, and each boundary face is as high, and the mesh as far from each side, as three times
/// tie_bound() for origins up to 3 radii of the mesh's bounding sphere from its centre. No camera is farther away.
/// grid: of the scene, by make_entry_grid().
/// Returns an empty string, or what is wrong and where, with both numbers and what to do.
[[nodiscard]] std::string find_weak_side(const Scene& scene, const EntryGrid& grid);

} // namespace tetrace
