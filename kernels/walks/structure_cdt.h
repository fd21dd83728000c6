// The kernels of a CDT: a layout of tets, a method that finds the face by which a ray leaves a tet, and a walk. The
// method selects the walk: a method that defines WALKS_PATHS walks along paths, and carries vertices on layouts with
// records (half32.h, tet64.h). Any other method walks by links.
#include "kernels/layouts/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/walks/start.h"

#include KERNEL_METHOD_HEADER

#include "kernels/walks/entry.h"

#include "kernels/walks/entry_links.h"

#include "kernels/walks/triangle_hit.h"

#ifdef WALKS_PATHS
#include "kernels/walks/entry_on_path.h"

#include "kernels/walks/path.h"

#ifdef HAS_RECORDS
#include "kernels/walks/carried.h"

#include "kernels/walks/walk_by_records.h"
#else
#include "kernels/walks/links.h"

#include "kernels/walks/walk_along_paths.h"
#endif

#include "kernels/walks/trace_along_paths.h"
#else
#include "kernels/walks/entry_nearest.h"

#include "kernels/walks/links.h"

#include "kernels/walks/walk_by_links.h"
#endif

#ifndef HAS_RECORDS
#include "kernels/walks/search.h"
#endif
