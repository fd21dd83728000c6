// A whole kernel; include it after a dialect header, vector.h and the dialect's SceneView. Every other kernel header
// includes what it uses. Macros tell the parts of a kernel about each other:
//
// | macro | set by | read by |
// |--------------------------------------------------|-----------------------------|------------------------------------|
// | KERNEL_STRUCTURE_HEADER, _ARRAYS_, _LAYOUT_, | build (cmake/Kernels.cmake) | #include lines: structure_*.h, | |
// _METHOD_, _LOOP_ (of a BVH) | | *_arrays.h, layout, method, loop | | TETS_IN_PARTS, QUADS_COST_AS_WORDS | host, texel
// scene view | scene views, tet80.h | | STACK_TOP, STACK_ENTRIES, GROUP_ITEMS | host or entry file | stack.h, dialects
// | | DEFERS_TIES | entry file | entry_on_path.h, walk_*.h | | KEEP_BRANCH, RARE_FN, PRECISE, HAS_FLOAT4, ... | dialect
// | walk_by_records.h, bvh/ | | HOST_SSE2 | openmp/kernel.cpp | bvh/ | | LANES_VOTE | dialect_cuda.h | structure_bvh.h,
// cwbvh.h | | HAS_RECORDS, RECORD_EXITS, RecordExits, | half32.h, tet64.h | structure_cdt.h, | | EXIT_REPLACING,
// ROTATION_OF_CORNERS, _AFTER | | walk_by_records.h | | TRIANGLE_OF | tet64.h | triangle_hit.h | | FACE_QUAD |
// tet80_quads.h, tet96.h | face_quads.h | | NEIGHBOUR | tet16.h, tet20.h | walk_compact.h | | AS_SEEN | plucker.h,
// stp.h | whole_face.h | | WALKS_PATHS | project.h | structure_cdt.h | | Beginning, BEGINNING_AT, BEGINNING_IN |
// walk_by_records.h, | trace_along_paths.h | | | walk_along_paths.h | | | TRAVERSAL_ENTRIES, _AT_ROOT, _GOES_ON |
// bvh2.h, bvh4.h, cwbvh.h | refill_cuda.h | | TAKES_RAYS, STARTS_IN_TETS, SEARCHES_EXITS | methods, entry.h, search.h,
// | entry files: which tasks there are | | | structure_bvh.h | | | COUNT_SIGN, COUNT_SEARCH, COUNT_NODE, | tests and
// counting builds | signs.h, entry_on_path.h, bvh.h | | COUNT_TRIANGLE | | |
#include "kernels/hit.h"
#include "kernels/launch.h"
#include "kernels/ray.h"
#include KERNEL_STRUCTURE_HEADER
