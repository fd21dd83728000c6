// The kernels of a CDT: a layout of tets, a method that finds the face by which a ray leaves a tet, and a walk. The
// method selects the walk: a method that defines WALKS_PATHS walks along paths, and carries vertices on layouts with
// records (half32.h, tet64.h). Any other method walks by half-faces.
#include KERNEL_METHOD_HEADER
#include "kernels/walks/entry_half_faces.h"
#include "kernels/walks/triangle_hit.h"
#ifdef WALKS_PATHS
#include "kernels/walks/path.h"
#ifdef HAS_RECORDS
#include "kernels/walks/walk_by_records.h"
#else
#include "kernels/walks/walk_along_paths.h"
#endif

#include "kernels/walks/trace_along_paths.h"
#else
#include "kernels/walks/walk_by_neighbours.h"
#endif
#ifndef HAS_RECORDS
#include "kernels/walks/search.h"
#endif
#ifndef KERNEL_REAL_HAS_NO_BITS
#include "kernels/walks/segments.h"
#endif
