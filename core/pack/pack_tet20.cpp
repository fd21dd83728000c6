#include "core/pack/pack_compact.h"
#include "core/pack/traits.h"

namespace tetrace {

void pack_tet20(PackedScene& packed, const TetMesh& mesh)
{
    pack_compact(
        packed, mesh, *[](std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind) {
            words.insert(words.end(), {vertices, behind[0], behind[1], behind[2], behind[3]});
        });
}

} // namespace tetrace
