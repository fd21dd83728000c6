#include "core/bvh/triangle_split.h"

namespace tetrace {
namespace {

/// The point where an edge crosses the plane, as a box: one corner is rounded down, the other up.
Box crossing(Double3 from, Double3 to, int axis, double position)
{
    const double coordinates[2][3] = {{from.x, from.y, from.z}, {to.x, to.y, to.z}};
    const double t = (position - coordinates[0][axis]) / (coordinates[1][axis] - coordinates[0][axis]);
    Box box;
    for (int i = 0; i < 3; ++i) {
        const double x = i == axis ? position : coordinates[0][i] + t * (coordinates[1][i] - coordinates[0][i]);
        const double error = i == axis ? 0 : 0x1p-50 * (std::abs(coordinates[0][i]) + std::abs(coordinates[1][i]));
        box.low[i] = float_below(x - error);
        box.high[i] = float_above(x + error);
    }
    return box;
}

} // namespace

TriangleParts split_triangle(const Float3 (&corners)[3], int axis, float position, const Box& box)
{
    TriangleParts parts;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float3 from = corners[i];
        const Float3 to = corners[(i + 1) % 3];
        if (from[axis] <= position) parts.below = merged(parts.below, {from, from});
        if (from[axis] >= position) parts.above = merged(parts.above, {from, from});
        if ((from[axis] < position && to[axis] > position) || (from[axis] > position && to[axis] < position)) {
            const Box point = crossing(to_double(from), to_double(to), axis, position);
            parts.below = merged(parts.below, point);
            parts.above = merged(parts.above, point);
        }
    }
    return {common(parts.below, box), common(parts.above, box)};
}

} // namespace tetrace
