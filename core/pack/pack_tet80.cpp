#include "core/pack/pack_corners.h"
#include "core/pack/traits.h"

namespace tetrace {

static_assert(corner_quads(3) == TET80_QUADS);

void pack_tet80(PackedScene& packed, const TetMesh& mesh)
{
    pack_corners(packed, mesh, 3);
}

} // namespace tetrace
