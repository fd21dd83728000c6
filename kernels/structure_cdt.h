// The kernels of a CDT: a layout of tets, a method that finds the face a ray leaves a tet by, and the walk.
#include "kernels/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/start.h"

#include KERNEL_METHOD_HEADER

#include "kernels/entry_links.h"

#include "kernels/path.h"

#include "kernels/triangle_hit.h"

#ifdef HAS_RECORDS
#include "kernels/carried_walk.h"
#else
#include "kernels/walk.h"

#include "kernels/search.h"
#endif
