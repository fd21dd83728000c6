#pragma once

#include "core/base/enum_names.h"
#include "core/mesh/tet_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// How far the box that the CDT fills reaches. Scene files and hashes hold the values.
enum class DomainKind {
    tight = 0, ///< the mesh's bounding box grown by 2 % of its largest extent; rays mostly enter from outside
    wide = 1,  ///< a cube of half-size 3 bounding-sphere radii; cameras are inside, as in the paper
};
template <>
inline constexpr auto enum_names<DomainKind> = names_up_to<DomainKind::wide>("tight", "wide");

/// The box that the tets fill, its sides cut into divisions x divisions squares, in which rays look up the boundary
/// face by which they enter. TetGen's tets keep to the squares, others need not (core/mesh/entry_grid.h). lines[axis]
/// holds divisions + 1 ascending coordinates; the first and last are the box's own.
struct Domain {
    DomainKind kind = DomainKind::tight;
    std::uint32_t divisions = 1;
    std::array<std::vector<float>, 3> lines;

    [[nodiscard]] Float3 low() const { return {lines[0].front(), lines[1].front(), lines[2].front()}; }
    [[nodiscard]] Float3 high() const { return {lines[0].back(), lines[1].back(), lines[2].back()}; }
    [[nodiscard]] bool contains(Float3 point) const; ///< closed: the boundary is inside

    friend bool operator==(const Domain&, const Domain&) = default;
};

/// The domain of a placed mesh. divisions >= 1. Lines are multiples of 2^-20, so they are exact in float.
[[nodiscard]] Domain make_domain(const TriangleMesh& mesh, DomainKind kind, std::uint32_t divisions);

/// The surface of the domain as triangles, two a square, wound outwards; vertices shared. What the CDT must contain.
[[nodiscard]] TriangleMesh domain_surface(const Domain& domain);

} // namespace tetrace
