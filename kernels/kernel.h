// A whole kernel, after a dialect header and its SceneView: which layout and method is said by KERNEL_LAYOUT_HEADER and
// KERNEL_METHOD_HEADER. The order matters: kernel headers include nothing themselves, because not every language that
// reads them can.
#include "kernels/vector.h"

#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/faces.h"

#include KERNEL_LAYOUT_HEADER

#include "kernels/start.h"

#include KERNEL_METHOD_HEADER

#include "kernels/entry.h"

#include "kernels/walk.h"

#include "kernels/launch.h"

#include "kernels/search.h"
