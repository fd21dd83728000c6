// A whole kernel; include it after a dialect header, vector.h and the dialect's SceneView. KERNEL_STRUCTURE_HEADER
// names the structure, structure_<family>.h, which includes KERNEL_LAYOUT_HEADER and, if it needs one,
// KERNEL_METHOD_HEADER; of a BVH also KERNEL_LOOP_HEADER, the loop of lanes that fetch rays for themselves. The order
// matters: kernel headers include others only by these names, because not every language can include files.
#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/launch.h"

#include KERNEL_STRUCTURE_HEADER
