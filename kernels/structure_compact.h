// The kernels of a CDT whose tets share their vertices, and name no corner: a layout and the walk of method project,
// which carries the vertices of the face that it is at.
#include "kernels/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/signs.h"

#include "kernels/entry_faces.h"

#include "kernels/triangle_hit.h"

#include "kernels/compact_walk.h"
