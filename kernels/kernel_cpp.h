// A whole kernel in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h). The including file defines
// layout and method, see kernel.h.
#include "kernels/language/undefine_cpp.h"

#include "kernels/language/dialect_cpp.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_cpp.h"

#include "kernels/kernel.h"

#include "kernels/language/view_cpp.h"

#include "kernels/language/params_cpp.h"
