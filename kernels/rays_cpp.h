// Vectors and primary rays in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h).
#include "kernels/language/undefine_cpp.h"

#include "kernels/language/dialect_cpp.h"

#include "kernels/language/vector.h"

#include "kernels/ray.h"

#include "kernels/language/view_cpp.h"
