#include "tests/support/bvh_scene.h"

#include "backends/embree/bvh_builder.h"
#include "core/pack/pack_bvh.h"

namespace tetrace {

PackedScene make_bvh_scene(const TriangleMesh& mesh, Layout layout, unsigned threads)
{
    return pack_bvh(mesh, build_bvh(mesh, threads).bvh, layout);
}

} // namespace tetrace
