// A thousand spheres far apart, the largest a hundred times as large as the smallest.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tetrace {

namespace {

constexpr std::uint32_t count = 1000;

struct Sphere {
    Double3 centre;
    double radius;
};

/// Large ones first, each where it is at least half its radius away from those before it.
std::vector<Sphere> place_spheres()
{
    constexpr double half_size = 10, largest = 1.5, smallest = 0.015;
    std::vector<Sphere> placed;
    for (std::uint32_t draw = 0; placed.size() < count; ++draw) {
        const double share = 1 - static_cast<double>(placed.size()) / (count - 1);
        const double radius = smallest + (largest - smallest) * share * share * share * share * share;
        const auto coordinate = [&](std::uint32_t axis) {
            return (2 * random_unit(axis, draw) - 1) * (half_size - radius);
        };
        const Double3 centre = {coordinate(0), coordinate(1), coordinate(2)};
        if (std::ranges::all_of(placed, [&](const Sphere& other) {
                return length(centre - other.centre) > 1.5 * radius + other.radius;
            }))
            placed.push_back({centre, radius});
    }
    return placed;
}

} // namespace

TriangleMesh make_spheres(std::uint32_t triangles)
{
    // Each edge of the octahedra is cut in n, and of the largest spheres in n + 1.
    const auto n = static_cast<std::uint32_t>(std::sqrt(triangles / (8.0 * count)));
    const auto finer = static_cast<std::size_t>((triangles - 8.0 * count * n * n) / (8.0 * (2 * n + 1)));
    MeshBuilder mesh;
    const std::vector<Sphere> spheres = place_spheres();
    for (std::size_t i = 0; i < spheres.size(); ++i)
        mesh.sphere(spheres[i].centre, spheres[i].radius, n + (i < finer ? 1 : 0), [](Double3) { return 1.0; });
    return mesh.take();
}

} // namespace tetrace
