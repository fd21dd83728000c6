// Blades of grass on a floor: each is bent, three triangles, thin and open, and close above the floor.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <cmath>

namespace tetrace {

TriangleMesh make_grass(std::uint32_t triangles)
{
    constexpr double size = 16;
    constexpr std::uint32_t tiles = 16; // of the floor, along a side
    const auto blades =
        static_cast<std::uint32_t>(std::lround(std::sqrt((triangles - 2.0 * tiles * tiles) / 3))); // along a side
    const double spacing = size / blades;
    MeshBuilder mesh;
    for (std::uint32_t j = 0; j < blades; ++j)
        for (std::uint32_t i = 0; i < blades; ++i) {
            const auto random = [&](std::uint32_t stream) { return 2 * random_unit(stream, j * blades + i) - 1; };
            // Nothing of a blade leaves its square, so blades do not cross.
            const Double3 root = {(i + 0.5 + 0.1 * random(0)) * spacing, 0.02 * spacing,
                                  (j + 0.5 + 0.1 * random(1)) * spacing};
            const Double3 tip = Double3{0.3 * random(2) * spacing, 0.6 + 0.25 * random(3), 0.3 * random(4) * spacing};
            const double x = random(5), z = random(6), reach = 0.06 * spacing / std::sqrt(x * x + z * z + 1e-6);
            const Double3 side = {x * reach, 0, z * reach};
            const Double3 bend = {tip.x * 0.3, tip.y * 0.6, tip.z * 0.3};
            const std::uint32_t left = mesh.vertex(root + bend - side * 0.7),
                                right = mesh.vertex(root + bend + side * 0.7);
            mesh.quad(mesh.vertex(root - side), mesh.vertex(root + side), right, left);
            mesh.triangle(left, right, mesh.vertex(root + tip));
        }
    for (std::uint32_t j = 0; j < tiles; ++j)
        for (std::uint32_t i = 0; i < tiles; ++i) {
            const double x = size * i / tiles, z = size * j / tiles, step = size / tiles;
            mesh.quad({{{x, 0, z}, {x, 0, z + step}, {x + step, 0, z + step}, {x + step, 0, z}}});
        }
    return mesh.take();
}

} // namespace tetrace
