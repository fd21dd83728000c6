#pragma once

#include "scenes/optimise/editable_mesh.h"

namespace tetrace {

/// Face removal, the inverse of removing an edge with three tets: the two tets of a free face become three round the
/// edge between the vertices opposite it. Returns by how much cost fell; 0 where the face stays, since cost would fall
/// by `least` or less, or a tet may not be made. face: 0..3.
double try_face(EditableMesh& mesh, std::uint32_t tet, std::uint32_t face, double least);

} // namespace tetrace
