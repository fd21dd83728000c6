// Vectors and primary rays in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h). The order matters:
// kernel headers include nothing themselves, because not every language that reads them can.
#include "kernels/dialect_cpp.h"

#include "kernels/vector.h"

#include "kernels/ray.h"

inline Vec3 to_vec3(tetrace::Float3 a)
{
    return VEC3(real(a.x), real(a.y), real(a.z));
}

[[maybe_unused]] inline TraceParams params_of(const tetrace::TraceJob& job)
{
    return {to_vec3(job.view.origin),
            to_vec3(job.view.corner),
            to_vec3(job.view.step_x),
            to_vec3(job.view.step_y),
            job.width,
            job.height,
            job.start_tet,
            job.max_steps};
}
