#pragma once

#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetrace {

/// A closed box with faces along the axes; empty by default.
struct Box {
    Float3 low = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                  std::numeric_limits<float>::infinity()};
    Float3 high = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity()};

    friend bool operator==(const Box&, const Box&) = default;
};

/// The largest float that is not above x, and the smallest that is not below.
[[nodiscard]] inline float float_below(double x)
{
    const auto nearest = static_cast<float>(x);
    return nearest > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
[[nodiscard]] inline float float_above(double x)
{
    return -float_below(-x);
}

[[nodiscard]] inline bool is_empty(const Box& box)
{
    return box.low.x > box.high.x || box.low.y > box.high.y || box.low.z > box.high.z;
}

[[nodiscard]] inline bool contains(const Box& outer, const Box& inner)
{
    for (int axis = 0; axis < 3; ++axis)
        if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis]) return false;
    return true;
}

/// The smallest box that holds both.
[[nodiscard]] inline Box merged(const Box& a, const Box& b)
{
    return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
            {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

/// The intersection; the empty box where they do not meet.
[[nodiscard]] inline Box common(const Box& a, const Box& b)
{
    const Box box = {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
                     {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
    return is_empty(box) ? Box{} : box;
}

/// At least `margin` larger on every side.
[[nodiscard]] inline Box grown(const Box& box, double margin)
{
    return {{float_below(box.low.x - margin), float_below(box.low.y - margin), float_below(box.low.z - margin)},
            {float_above(box.high.x + margin), float_above(box.high.y + margin), float_above(box.high.z + margin)}};
}

/// Half the surface area, the weight of the surface area heuristic; 0 for the empty box.
[[nodiscard]] inline double half_area(const Box& box)
{
    if (is_empty(box)) return 0;
    const Double3 size = to_double(box.high) - to_double(box.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

[[nodiscard]] inline Double3 centre(const Box& box)
{
    return (to_double(box.low) + to_double(box.high)) * 0.5;
}

/// The box of one triangle of the mesh.
[[nodiscard]] inline Box triangle_box(const TriangleMesh& mesh, std::size_t triangle)
{
    Box box;
    for (const auto v : mesh.triangles[triangle])
        box = merged(box, {mesh.vertices[v], mesh.vertices[v]});
    return box;
}

} // namespace tetrace
