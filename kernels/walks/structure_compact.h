// The kernels of a CDT whose tets share their vertices and do not name their corners: a layout, and the walk of method
// project, which carries the vertices of the current face.
#include "kernels/layouts/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/methods/signs.h"

#include "kernels/walks/entry.h"

#include "kernels/walks/entry_faces.h"

#include "kernels/walks/entry_on_path.h"

#include "kernels/walks/triangle_hit.h"

#include "kernels/walks/carried.h"

#include "kernels/walks/walk_compact.h"
