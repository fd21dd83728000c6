#include "bench/rows/contest.h"

namespace tetrace {

bool is_single_ray(const KernelId& kernel)
{
    if (is_embree(kernel.layout)) return kernel.method == Method::single;
    return kernel.schedule != Schedule::packets;
}

bool is_of(const KernelId& kernel, Walk walk)
{
    if (kernel.structure != Structure::cdt) return false;
    const auto is_project_on = [&](Layout layout) {
        return kernel.method == Method::project && kernel.layout == layout && is_single_ray(kernel);
    };
    switch (walk) {
    case Walk::half32: return is_project_on(Layout::half32);
    case Walk::tet64: return is_project_on(Layout::tet64);
    case Walk::maria: return kernel.method == Method::maria && is_single_ray(kernel);
    case Walk::packets: return kernel.schedule == Schedule::packets;
    case Walk::single: return is_single_ray(kernel);
    case Walk::any: return true;
    }
    return false;
}

bool is_of(const KernelId& kernel, Rival rival)
{
    if (kernel.structure != Structure::bvh) return false;
    switch (rival) {
    case Rival::our_single: return is_portable(kernel) && is_single_ray(kernel);
    case Rival::embree_single: return is_embree(kernel.layout) && kernel.method == Method::single;
    case Rival::embree: return is_embree(kernel.layout);
    case Rival::single: return is_single_ray(kernel);
    case Rival::any: return true;
    }
    return false;
}

bool is_of(const KernelId& kernel, Layout layout)
{
    return kernel.layout == layout;
}

} // namespace tetrace
