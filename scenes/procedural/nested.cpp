// A cube around three spheres with one centre, as benchmark B2 of MMC has them (Yan, Tran, Fang 2019): a thin layer of
// another medium, and a core.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tetrace {

TriangleMesh make_nested(std::uint32_t triangles)
{
    constexpr double half_size = 30;
    constexpr std::array<double, 3> radii{25, 23, 10};
    double squares = 0;
    for (const double radius : radii)
        squares += radius * radius;
    const double edges_per_unit = std::sqrt(triangles / (8 * squares));
    MeshBuilder mesh;
    mesh.box({-half_size, -half_size, -half_size}, {half_size, half_size, half_size});
    for (const double radius : radii)
        mesh.sphere({0, 0, 0}, radius, static_cast<std::uint32_t>(std::max(1.0, radius * edges_per_unit + 0.5)),
                    [](Double3) { return 1.0; });
    return mesh.take();
}

} // namespace tetrace
