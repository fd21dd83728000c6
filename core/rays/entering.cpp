#include "core/rays/entering.h"

#include "core/pack/packed_scene.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace tetrace {

namespace {
namespace kernel {
#include "kernels/rays_cpp.h"

Double3 pixel_direction(const View& view, std::uint32_t x, std::uint32_t y)
{
    const Vec3 direction = primary_ray(params_of(view), x, y).direction;
    return {direction.x, direction.y, direction.z};
}
} // namespace kernel

} // namespace

bool enters(const Domain& domain, Double3 origin, Double3 direction, double end)
{
    double from = 0, to = end;
    const Double3 low = to_double(domain.low()), high = to_double(domain.high());
    const auto clip = [&](double o, double d, double l, double h) {
        if (d == 0) return o > l && o < h;
        from = std::max(from, ((d > 0 ? l : h) - o) / d);
        to = std::min(to, ((d > 0 ? h : l) - o) / d);
        return true;
    };
    return clip(origin.x, direction.x, low.x, high.x) && clip(origin.y, direction.y, low.y, high.y) &&
           clip(origin.z, direction.z, low.z, high.z) && from < to;
}

std::uint64_t count_entering(const Domain& domain, const View& view, std::uint32_t width, std::uint32_t height)
{
    std::uint64_t count = 0;
    const Double3 origin = to_double(view.origin);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            count += enters(domain, origin, kernel::pixel_direction(view, x, y)) ? 1 : 0;
    return count;
}

std::uint64_t count_entering(const Domain& domain, std::span<const GivenRay> rays)
{
    return static_cast<std::uint64_t>(std::ranges::count_if(rays, [&](const GivenRay& ray) {
        return enters(domain, to_double(ray.origin), to_double(ray.direction), static_cast<double>(ray.end));
    }));
}

} // namespace tetrace
