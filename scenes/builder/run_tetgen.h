#pragma once

#include "core/mesh/triangle_mesh.h"
#include "scenes/builder/raw_tets.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tetrace {

/// Throws Error{usage} unless the switches begin with p and all of them are among those that change the mesh: p q a A Y
/// M T O S D C V X.
void require_switches(const std::string& switches);

/// Tetrahedralizes the inside of `surface` (the domain's) with every triangle of `mesh` as a constraint, and `points`
/// of its inside as more vertices. order: 0 gives TetGen vertices and triangles as they are, every other number in an
/// order of its own (the last two digits of BuilderOptions::order): whether TetGen fails depends on it.
/// TetGen throws an int where it fails, and libtet cannot be unwound: no caller may catch it or run clean-up. So call
/// it from main with std::set_terminate(explain_tetgen_failure), or where failure is not expected.
[[nodiscard]] RawTets run_tetgen(const TriangleMesh& mesh, const TriangleMesh& surface,
                                 const std::vector<Float3>& points, const std::string& switches,
                                 std::uint32_t order = 0);

/// A terminate handler: prints one `error:` line about TetGen's int (or std::bad_alloc) and ends the process with
/// BUILDER_TETGEN_REFUSED or BUILDER_OUT_OF_MEMORY; aborts for anything else.
[[noreturn]] void explain_tetgen_failure();

} // namespace tetrace
