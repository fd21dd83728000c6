#include "scenes/builder/vtk_cells.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tetrace {
namespace {

constexpr std::array<std::string_view, no_region_array> region_names = {
    "region", "medit:ref", "gmsh:physical", "tetgen:ref", "cell_tags", "regions", "materialids"};

} // namespace

std::size_t region_rank(std::string_view name)
{
    return static_cast<std::size_t>(std::ranges::find(region_names, lower_case(name)) - region_names.begin());
}

std::int64_t region_of_value(const MeshSource& source, double value, const std::string& place)
{
    if (!(std::abs(value) < 0x1p31) || value != std::floor(value))
        source.fail(place, fmt::format("{} is not a whole number of 32 bits, as a region must be", value));
    return static_cast<std::int64_t>(value);
}

void add_vtk_cell(MeshSource& source, std::int64_t type, std::vector<std::int64_t>& corners, FileTet tet,
                  const std::string& place)
{
    const bool is_tet = type == 10 || type == 24, is_triangle = type == 5 || type == 22,
               is_quad = type == 9 || type == 23;
    if ((type >= 1 && type <= 4) || type == 21) return; // points and lines
    if (!is_tet && !is_triangle && !is_quad && type != 7)
        source.fail(place, fmt::format("its type is {}, which is not a tet", type), split_into_tets);
    const std::size_t needed = is_triangle ? 3 : is_tet || is_quad ? 4 : corners.size();
    if (corners.size() < needed) source.fail(place, "it has too few corners for its type");
    corners.resize(needed);
    if (is_tet)
        source.add_tet(corners, source.vertex_count(), tet, place);
    else
        source.add_face(corners, source.vertex_count(), place);
}

void note_without_regions(MeshSource& source)
{
    source.note(fmt::format("no array of the cells is named region (or {}): all tets are of one region",
                            fmt::join(region_names.begin() + 1, region_names.end(), ", ")));
}

} // namespace tetrace
