// Vectors and primary rays in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h). The order matters:
// kernel headers include nothing themselves, because not every language that reads them can.
#include "kernels/dialect_cpp.h"

#include "kernels/vector.h"

#include "kernels/ray.h"

inline Vec3 to_vec3(tetrace::Float3 a)
{
    return VEC3(real(a.x), real(a.y), real(a.z));
}
