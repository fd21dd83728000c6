#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/tet_mesh.h"
#include "scenes/builder/mend_tets.h"
#include "scenes/builder/raw_tets.h"

namespace tetrace {

/// Makes a tet mesh of raw tets: half-faces from its neighbours, input triangles from its surface faces, the
/// orientation of core/mesh/tet_mesh.h. Steiner points are rounded to float and grid; those on a side of the domain
/// stay in its plane. Where rounding flattens or inverts a tet, mend_tets() changes Steiner points; vertices of the
/// input never move. What cannot be mended stays, for find_defect. Throws BuilderFailure{BUILDER_ABSURD_OUTPUT} where
/// an index, a neighbour or a surface face is impossible.
[[nodiscard]] TetMesh convert_tets(const RawTets& output, const TriangleMesh& triangles, const Domain& domain,
                                   Rounding& rounding);

} // namespace tetrace
