#include "core/rays/ray_order.h"

#include "core/base/random_words.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tetrace {
namespace {

constexpr std::uint32_t origin_bits = 6;    // along an axis
constexpr std::uint32_t direction_bits = 4; // along an axis
constexpr std::uint32_t shuffle_stream = 0x100;

struct OriginBox {
    Float3 low{HUGE_VALF, HUGE_VALF, HUGE_VALF}, high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
};

OriginBox box_of_origins(const std::vector<GivenRay>& rays)
{
    OriginBox box;
    for (const GivenRay& ray : rays)
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], ray.origin[axis]);
            box.high[axis] = std::max(box.high[axis], ray.origin[axis]);
        }
    return box;
}

// unit: 0 to 1.
std::uint32_t cell_of(double unit, std::uint32_t bits)
{
    const std::uint32_t cells = 1u << bits;
    return std::min(static_cast<std::uint32_t>(unit * cells), cells - 1);
}

std::uint64_t interleaved(const std::uint32_t (&cell)[3], std::uint32_t bits)
{
    std::uint64_t index = 0;
    for (std::uint32_t bit = bits; bit-- > 0;)
        for (const std::uint32_t axis : cell)
            index = index << 1 | (axis >> bit & 1u);
    return index;
}

std::uint64_t morton_key(const GivenRay& ray, const OriginBox& box)
{
    const Double3 direction = normalized(to_double(ray.direction));
    std::uint32_t at[3], towards[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(box.low[axis]), high = static_cast<double>(box.high[axis]);
        const double along = static_cast<double>(ray.origin[axis]) - low;
        at[axis] = cell_of(high > low ? along / (high - low) : 0.0, origin_bits);
        const double component = axis == 0 ? direction.x : axis == 1 ? direction.y : direction.z;
        towards[axis] = cell_of(std::clamp(0.5 * (component + 1), 0.0, 1.0), direction_bits);
    }
    return interleaved(at, origin_bits) << (3 * direction_bits) | interleaved(towards, direction_bits);
}

std::vector<std::uint64_t> morton_keys(const RaySet& set)
{
    const OriginBox box = box_of_origins(set.rays);
    std::vector<std::uint64_t> keys;
    for (const GivenRay& ray : set.rays)
        keys.push_back(morton_key(ray, box));
    return keys;
}

std::vector<std::uint64_t> random_keys(const RaySet& set)
{
    std::vector<std::uint64_t> keys;
    for (std::uint32_t i = 0; i < set.rays.size(); ++i) {
        const RandomWords words = random_words({set.view, i, static_cast<std::uint32_t>(set.kind), 0}, shuffle_stream);
        keys.push_back(std::uint64_t{words[0]} << 32 | words[1]);
    }
    return keys;
}

void sort_by(std::vector<GivenRay>& rays, const std::vector<std::uint64_t>& keys)
{
    std::vector<std::uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](auto a, auto b) { return keys[a] < keys[b]; });
    std::vector<GivenRay> sorted;
    sorted.reserve(rays.size());
    for (const std::uint32_t i : order)
        sorted.push_back(rays[i]);
    rays = std::move(sorted);
}

} // namespace

void arrange(RaySet& set, RayOrder order)
{
    if (order == RayOrder::morton) sort_by(set.rays, morton_keys(set));
    if (order == RayOrder::shuffled) sort_by(set.rays, random_keys(set));
    set.order = order;
}

} // namespace tetrace
