#include "core/pack/pack_corners.h"
#include "core/pack/traits.h"

namespace tetrace {

static_assert(corner_quads(4) == TET96_QUADS);

void pack_tet96(PackedScene& packed, const TetMesh& mesh)
{
    pack_corners(packed, mesh, 4);
}

} // namespace tetrace
