// A whole kernel in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h): the including file says which
// layout and method by KERNEL_LAYOUT_HEADER and KERNEL_METHOD_HEADER. The order matters, as in rays_cpp.h.
#include "kernels/rays_cpp.h"

#include "kernels/scene_view_cpp.h"

#include "kernels/faces.h"

#include KERNEL_LAYOUT_HEADER

#include KERNEL_METHOD_HEADER

#include "kernels/entry.h"

#include "kernels/walk.h"
