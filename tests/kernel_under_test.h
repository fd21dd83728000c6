// The kernels as a test sees them: layout tet96, scalar C++, to be included in an unnamed namespace after KERNEL_REAL
// is chosen. The including file brings the standard headers that kernels/dialect_cpp.h names.
#include "kernels/dialect_cpp.h"
#include "kernels/entry.h"
#include "kernels/faces.h"
#include "kernels/maria.h"
#include "kernels/ray.h"
#include "kernels/scene_view_cpp.h"
#include "kernels/tet96.h"
#include "kernels/vector.h"
#include "kernels/walk.h"

Vec3 to_vec3(tetrace::Float3 a)
{
    return VEC3(real(a.x), real(a.y), real(a.z));
}
