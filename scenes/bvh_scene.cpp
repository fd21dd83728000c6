#include "scenes/bvh_scene.h"

#include "core/pack_bvh.h"
#include "scenes/bvh_builder.h"

namespace tetrace {

PackedScene make_bvh_scene(const TriangleMesh& mesh, Layout layout, unsigned threads)
{
    return pack_bvh(mesh, build_bvh(mesh, threads).bvh, layout);
}

} // namespace tetrace
