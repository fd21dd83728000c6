#include "core/mesh/triangle_mesh.h"

#include <algorithm>

namespace tetrace {

std::array<Double3, 2> bounding_box(const TriangleMesh& mesh)
{
    Double3 low = to_double(mesh.vertices.front());
    Double3 high = low;
    for (const Float3 vertex : mesh.vertices) {
        const Double3 v = to_double(vertex);
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    return {low, high};
}

BoundingSphere bounding_sphere(const TriangleMesh& mesh)
{
    const auto [low, high] = bounding_box(mesh);
    return {(low + high) * 0.5, 0.5 * length(high - low)};
}

} // namespace tetrace
