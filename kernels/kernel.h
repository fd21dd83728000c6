// A whole kernel; include it after a dialect header, vector.h and the dialect's SceneView. A part that says "include it
// after" needs what one of several others defines. The macros by which the parts refer to each other; the reader has a
// default for those that need not be set:
//
// clang-format off
// macro                                      set by                     read by
// KERNEL_STRUCTURE_HEADER                    cmake/Kernels.cmake        kernel.h
// KERNEL_ARRAYS_HEADER                       the same                   scene_view_*.h
// KERNEL_LAYOUT_HEADER                       the same                   walks, methods, structures
// KERNEL_METHOD_HEADER                       the same                   structure_cdt.h, walks
// KERNEL_LOOP_HEADER                         the same, for BVHs         refill_cuda.h
// KERNEL_REAL                                bench, to count operations dialect_cpp.h
// KERNEL_REAL_HAS_NO_BITS                    the same                   dialect_cpp.h, structure_cdt.h
// MATH_FAST                                  host                       dialect_glsl.h, dialect_opencl.h
// SCENE_IN_TEXELS                            host                       dialect_glsl.h
// TETS_IN_PARTS                              host                       scene_view_glsl.h, scene_view_opencl.h
// PREDICTS_BRANCHES                          host                       bvh4.h, dialect_opencl.h
// CALLS_FUNCTIONS                            host                       dialect_opencl.h
// GROUP_ITEMS                                host, kernel.comp          dialect_glsl.h, dialect_opencl.h
// QUADS_COST_AS_WORDS                        scene_view_texels_glsl.h   tet80.h
// STACK_TOP                                  host, entry file, dialect  stack.h, scene_view_opencl.h
// STACK_ENTRIES                              kernel.comp                stack.h, bvh2.h, bvh4.h, cwbvh.h
// DEFERS_TIES                                kernel.comp                bvh.h, entry_on_path.h, structure_*.h, walk_*.h
// SELECTS_MINIMA                             kernel.comp                dialect_glsl.h
// PRECISE, MAYBE_UNUSED                      dialects                   all parts
// KEEP_BRANCH                                dialects: C++, OpenCL      bvh*.h, *_predicted.h, walk_by_records.h
// KEEP_LOOP                                  dialects                   exact_order.h, wide_in_memory.h, dialect_cuda.h
// HAS_FLOAT4                                 dialect_opencl.h           bvh4.h
// WIDE_IN_REGISTERS                          dialect_glsl.h             exact_order.h
// HOST_SSE2                                  openmp/kernel.cpp          bvh*.h, cwbvh.h, next_face_predicted.h
// LANES_VOTE                                 dialect_cuda.h             structure_bvh.h, cwbvh.h
// HAS_RECORDS                                half32.h, tet64.h          structure_cdt.h
// RECORD_EXITS, EXIT_REPLACING, RecordExits  half32.h, tet64.h          walk_by_records.h, next_face_predicted.h
// ROTATION_OF_CORNERS, ROTATION_AFTER        half32.h, tet64.h          walk_by_records.h
// TRIANGLE_OF                                tet64.h                    triangle_hit.h
// FACE_QUAD                                  tet80.h, tet96.h           face_quads.h
// NEIGHBOUR                                  tet16.h, tet20.h           structure_compact.h
// AS_SEEN                                    plucker.h, stp.h           whole_face.h
// WALKS_PATHS                                project.h                  structure_cdt.h, segments.h
// TIE_AT                                     project.h                  walk_along_paths.h
// SIDE_AT_TIE                                tests                      signs.h
// WalkStart, WALK_START_AT, WALK_START_IN    walk_*.h                   trace_along_paths.h
// TRAVERSAL_ENTRIES                          bvh2.h, bvh4.h, cwbvh.h    refill_cuda.h
// TRAVERSAL_AT_ROOT, TRAVERSAL_GOES_ON       bvh2.h, bvh4.h, cwbvh.h    refill_cuda.h
// BVH4_PREDICTED                             bvh4.h                     bvh4_loop.h
// TOGETHER_ENTRIES                           cwbvh.h                    refill_cuda.h
// PUTS_TRIANGLES_OFF                         tests                      cwbvh.h, cwbvh_together_cuda.h
// REFILLS_LANES                              refill_cuda.h              cuda/kernel.cu
// ENOUGH_LANES                               tests                      refill_cuda.h
// TAKES_RAYS                                 methods, structure_bvh.h   entry files: which tasks there are
// STARTS_IN_TETS                             entry.h                    entry files
// FINDS_NO_EXIT                              methods that may find none segments.h
// SEARCHES_EXITS                             search.h                   entry files
// CROSSES_TETS                               segments.h                 entry files: segments, tally, absorb
// ADD_TO_SUM, LENGTH_SUMS, NO_SUMS, HAS_SUMS entry files with tally     segments.h
// NOTE_BEGIN, NOTE_CROSSING                  recording builds           segments.h
// DENSITY_OF, VALUE_OF                       tests                      absorption.h
// COUNT_SIGN                                 tests                      signs.h
// COUNT_SEARCH                               tests                      entry_on_path.h, path.h
// COUNT_NODE, COUNT_TRIANGLE                 tests, counting builds     bvh.h
// clang-format on
#include "kernels/hit.h"
#include "kernels/launch.h"
#include "kernels/ray.h"
#include KERNEL_STRUCTURE_HEADER
