// The kernels of a CDT whose tets share their vertices and do not name their corners: a layout, and the walk of method
// project, which carries the vertices of the current face.
#include "kernels/walks/walk_compact.h"
