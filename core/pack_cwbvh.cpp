#include "core/pack_bvh.h"

#include "core/error.h"

namespace tetrace {

PackedScene pack_cwbvh(const TriangleMesh&, const Bvh&)
{
    throw Error(ErrorKind::internal, "cwbvh: not written yet");
}

} // namespace tetrace
