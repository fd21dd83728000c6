#pragma once

#include "core/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tetrace {

/// TetGen's output in its own terms: corner i and neighbour i of a tet are opposite each other.
struct TetgenOutput {
    /// A face of the input that TetGen kept: an input triangle's, by its index, or the domain's (marker -1).
    struct SurfaceFace {
        std::array<std::int32_t, 3> corners;
        std::int32_t triangle;
    };

    std::vector<Double3> points; ///< the input's first (mesh, surface), in its order; then `points` and Steiner points
    std::size_t input_points = 0;
    std::vector<std::array<std::int32_t, 4>> tets;
    std::vector<std::array<std::int32_t, 4>> neighbours; ///< -1 outside the domain
    std::vector<SurfaceFace> surface_faces;
    std::uint64_t flat_tets = 0; ///< no volume, or a negative one, already in TetGen's double coordinates
};

/// Throws Error{usage} unless the switches begin with p and all of them are among those that change the mesh: p q a A Y
/// M T O S D C V X.
void require_switches(const std::string& switches);

/// Tetrahedralizes the inside of `surface` (the domain's) with every triangle of `mesh` as a constraint, and `points`
/// of its inside as more vertices. order: 0 gives TetGen vertices and triangles as they are, every other number in an
/// order of its own: whether TetGen fails depends on it.
/// TetGen throws an int where it fails, and libtet cannot be unwound: no caller may catch it or run clean-up. So call
/// it from main with std::set_terminate(explain_tetgen_failure), or where failure is not expected.
[[nodiscard]] TetgenOutput run_tetgen(const TriangleMesh& mesh, const TriangleMesh& surface,
                                      const std::vector<Float3>& points, const std::string& switches,
                                      std::uint32_t order = 0);

/// A terminate handler: prints one `error:` line about TetGen's int (or std::bad_alloc) and ends the process with
/// BUILDER_TETGEN_REFUSED or BUILDER_OUT_OF_MEMORY; aborts for anything else.
[[noreturn]] void explain_tetgen_failure();

} // namespace tetrace
