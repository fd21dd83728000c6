// Vectors and primary rays in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h).
#include "kernels/dialect_cpp.h"

#include "kernels/vector.h"

#include "kernels/ray.h"

#include "kernels/params_cpp.h"
