// A whole kernel, after a dialect header and its SceneView. KERNEL_STRUCTURE_HEADER says which structure, cdt.h or
// bvh.h, and that one which of KERNEL_LAYOUT_HEADER and KERNEL_METHOD_HEADER it needs. The order matters: kernel
// headers include nothing themselves but by these names, because not every language that reads them can.
#include "kernels/language/vector.h"

#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/launch.h"

#include KERNEL_STRUCTURE_HEADER
