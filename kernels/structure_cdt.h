// The kernels of a CDT: a layout of tets, a method that finds the face a ray leaves a tet by, and the walk.
#include "kernels/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/start.h"

#include KERNEL_METHOD_HEADER

#include "kernels/entry.h"

#include "kernels/path.h"

#include "kernels/walk.h"

#include "kernels/search.h"
