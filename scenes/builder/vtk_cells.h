#pragma once

#include "scenes/builder/mesh_source.h"

#include <string_view>

namespace tetrace {

/// What legacy VTK and .vtu have in common: types of cells, and arrays of regions.

/// Of the names of arrays that say a cell's region, as tetrace and meshio write them, the place of this one: the first
/// that a file has decides. no_region_array for others.
[[nodiscard]] std::size_t region_rank(std::string_view name);
inline constexpr std::size_t no_region_array = 7;

/// A cell's region; throws unless the value is a whole number of 32 bits.
[[nodiscard]] std::int64_t region_of_value(const MeshSource& source, double value, const std::string& place);

/// Adds a tet, a triangle or a polygon; leaves out points and lines. Of a cell of higher order only the corners, which
/// come first. Throws for other types of cells.
void add_vtk_cell(MeshSource& source, std::int64_t type, std::vector<std::int64_t>& corners, FileTet tet,
                  const std::string& place);

/// Tells the user that no array says regions.
void note_without_regions(MeshSource& source);

} // namespace tetrace
