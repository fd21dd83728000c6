#pragma once

#include "core/pack/packed_scene.h"

#include <vector>

namespace tetrace {

/// The records of layout half32: HALF32_QUADS quads for each tet and entry face, at its link.
/// tets: in packed order, valid (see find_defect); two vertices of one position have neighbouring ranks.
[[nodiscard]] std::vector<Quad> half32_records(const TetMesh& tets);

/// The tets that such records were made of, vertices merged by position.
/// Throws Error{internal} naming the record where what is said more than once is not said alike.
[[nodiscard]] TetMesh half32_tets(const std::vector<Quad>& records);

} // namespace tetrace
