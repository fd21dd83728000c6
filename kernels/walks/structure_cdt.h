// The kernels of a CDT: a layout of tets, a method that finds the face a ray leaves a tet by, and the walk.
#include "kernels/layouts/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/walks/start.h"

#include KERNEL_METHOD_HEADER

#include "kernels/walks/entry_links.h"

#include "kernels/walks/path.h"

#include "kernels/walks/triangle_hit.h"

#ifdef HAS_RECORDS
#include "kernels/walks/carried_walk.h"
#else
#include "kernels/walks/walk.h"

#include "kernels/walks/search.h"
#endif
