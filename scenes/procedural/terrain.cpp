// Mountains: a fractal height field, open at its sides and below.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <cmath>

namespace tetrace {

TriangleMesh make_terrain(std::uint32_t triangles)
{
    constexpr double size = 16;
    const auto n = static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / 2.0)));
    MeshBuilder mesh;
    const auto point = [&](std::uint32_t i, std::uint32_t j) {
        const double x = size * i / n, z = size * j / n;
        const double hills = fractal_noise({x / 8, 0, z / 8}, 3);
        const double ridges = 1 - std::abs(2 * fractal_noise({x / 2, 64, z / 2}, 6) - 1);
        return mesh.vertex({x, 1.5 * hills + 2 * hills * ridges * ridges, z});
    };
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            mesh.quad(point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j));
    return mesh.take();
}

} // namespace tetrace
