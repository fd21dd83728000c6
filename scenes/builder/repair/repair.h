#pragma once

#include "core/mesh/scene.h"
#include "core/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tetrace {

/// Passes after which repair() gives up a way. The crossing meshes of CGAL's data were clean after one
/// (results/repair.md).
inline constexpr std::uint32_t max_repair_passes = 10;

/// Crossing pairs of pieces at which it gives up a way, for this many in the mesh: faces that nearly overlap are
/// shattered, and each pass makes more.
[[nodiscard]] constexpr std::uint64_t max_pairs_of_pieces(std::uint64_t crossing_pairs)
{
    return 10 * crossing_pairs + 1000;
}

/// The tolerances of weld() that repair() tries, in domain units: of the triangles that still cross after cuts, then of
/// all.
inline constexpr std::array<double, 2> local_tolerances = {0x1p-24, 0x1p-20};
inline constexpr std::array<double, 4> weld_tolerances = {0x1p-20, 0x1p-18, 0x1p-16, 0x1p-14};

/// Cuts triangles that cross, overlap or touch, until every two triangles meet only in shared vertices and edges. First
/// along their exact intersections, by which no vertex moves. Where rounding makes new crossings without end, goes on
/// after the first cut by turns with weld(), of only the triangles that cross, and exact cuts, with each of
/// local_tolerances. If that has no end either, or if the first cut makes several times as many crossings, begins again
/// with weld() of all and each of weld_tolerances, in the first pass and then by turns, or in every pass. A way is left
/// when the crossings grow. at_least: with this tolerance or more, whether triangles cross or not; 0:
/// as said. scene: cleaned (clean_up) and placed, with as many origins as triangles; mesh, origins and build.repair
/// change. The mesh's bounding box grows by no more than the tolerance. Throws
/// BuilderFailure{BUILDER_SELF_INTERSECTION} where no way ends.
void repair(Scene& scene, double at_least = 0, const std::function<void(const std::string& stage)>& tell = {});

/// What was done, in one sentence, where something was. Lengths in mesh units.
[[nodiscard]] std::string repair_text(const BuildInfo& build);

/// What clean_up() took away.
struct CleanUp {
    std::uint64_t merged_vertices = 0;      ///< vertices at exactly the place of an earlier one
    std::uint64_t unused_vertices = 0;      ///< vertices of no remaining triangle
    std::uint64_t degenerate_triangles = 0; ///< a repeated vertex, or collinear vertices in exact arithmetic
    std::uint64_t duplicate_triangles = 0;  ///< the same three vertices, in any order, as an earlier triangle

    friend bool operator==(const CleanUp&, const CleanUp&) = default;
};

/// Merges vertices that are equal bit for bit (-0 counts as 0), then removes degenerate and duplicate triangles and
/// unused vertices. The order of what remains is kept. Coordinates are finite; indices are in range.
/// origins: as many values as triangles; those of removed triangles go too.
CleanUp clean_up(TriangleMesh& mesh, std::vector<std::uint32_t>& origins);
CleanUp clean_up(TriangleMesh& mesh);

} // namespace tetrace
