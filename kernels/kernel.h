// A whole kernel; include it after a dialect header, vector.h and the dialect's SceneView. Every other kernel header
// includes what it uses. The macros by which the parts of a kernel refer to each other:
//
// clang-format off
// macro                                           set by                       read by
// KERNEL_STRUCTURE_HEADER, _ARRAYS_, _LAYOUT_     build (cmake/Kernels.cmake)  the #include of that part
// KERNEL_METHOD_HEADER                            build                        the #include of that part
// KERNEL_LOOP_HEADER (BVH)                        build                        structure_bvh.h
// TETS_IN_PARTS, QUADS_COST_AS_WORDS              host, texel scene view       scene views, tet80.h
// STACK_TOP, STACK_ENTRIES, GROUP_ITEMS           host or entry file           stack.h, dialects
// DEFERS_TIES                                     entry file                   entry_on_path.h, walk_*.h, bvh.h
// KEEP_BRANCH, MAYBE_UNUSED, PRECISE, ...         dialect                      walk_by_records.h, bvh/
// HOST_SSE2                                       openmp/kernel.cpp            bvh/, next_face_predicted.h
// LANES_VOTE                                      dialect_cuda.h               structure_bvh.h, cwbvh.h
// HAS_RECORDS, RECORD_EXITS, RecordExits          half32.h, tet64.h            structure_cdt.h, walk_by_records.h
// EXIT_REPLACING                                  half32.h, tet64.h            walk_by_records.h
// ROTATION_OF_CORNERS, ROTATION_AFTER             half32.h, tet64.h            walk_by_records.h
// TRIANGLE_OF                                     tet64.h                      triangle_hit.h
// FACE_QUAD                                       tet80.h, tet96.h             face_quads.h
// NEIGHBOUR                                       tet16.h, tet20.h             structure_compact.h
// AS_SEEN                                         plucker.h, stp.h             whole_face.h
// WALKS_PATHS                                     project.h                    structure_cdt.h
// WalkStart, WALK_START_AT, WALK_START_IN         walk_by_records.h            walk_along_paths.h, trace_along_paths.h
// TRAVERSAL_ENTRIES, _AT_ROOT, _GOES_ON           bvh2.h, bvh4.h, cwbvh.h      refill_cuda.h
// REFILLS_LANES                                   refill_cuda.h                backends/cuda/kernel.cu
// ENOUGH_LANES                                    refill_cuda.h, tests         refill_cuda.h
// TAKES_RAYS, STARTS_IN_TETS                      methods, entry.h, bvh        entry files: which tasks there are
// FINDS_NO_EXIT                                   methods that may find none   segments.h
// SEARCHES_EXITS                                  search.h                     entry files
// CROSSES_TETS                                    segments.h                   entry files: segments, tally, absorb
// ADD_TO_SUM, LENGTH_SUMS, NO_SUMS, HAS_SUMS      entry files with task tally   segments.h
// NOTE_BEGIN, NOTE_CROSSING                       recording builds             segments.h
// DENSITY_OF, VALUE_OF                            absorption.h, tests          absorption.h
// COUNT_SIGN, COUNT_SEARCH                        tests, counting builds       signs.h, entry_on_path.h
// COUNT_NODE, COUNT_TRIANGLE                      tests, counting builds       bvh.h
// clang-format on
#include "kernels/hit.h"
#include "kernels/launch.h"
#include "kernels/ray.h"
#include KERNEL_STRUCTURE_HEADER
