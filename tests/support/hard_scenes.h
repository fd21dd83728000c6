#pragma once

#include "core/base/exact.h"
#include "scenes/procedural.h"
#include "tests/support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace tetrace::test {

/// The places of a grid's lines along each axis.
using Lines = std::array<std::vector<float>, 3>;

/// Moves each vertex of the tets, and of the surface with it, to place_of(its number).
template <class PlaceOf>
void move_vertices(Scene& scene, const PlaceOf& place_of)
{
    std::map<std::tuple<float, float, float>, Float3> moved;
    for (std::uint32_t i = 0; i < scene.tets.vertices.size(); ++i) {
        Float3& vertex = scene.tets.vertices[i];
        const Float3 place = place_of(i);
        moved[{vertex.x, vertex.y, vertex.z}] = place;
        vertex = place;
    }
    for (Float3& vertex : scene.mesh.vertices)
        vertex = moved.at({vertex.x, vertex.y, vertex.z});
}

/// `cubes` with its vertices on a grid of these lines; every tet keeps its orientation.
inline Scene grid_of(const Lines& lines)
{
    const auto n = static_cast<std::uint32_t>(lines[0].size() - 1);
    Scene scene = make_cubes(n);
    move_vertices(scene, [&](std::uint32_t i) {
        return Float3{lines[0][i % (n + 1)], lines[1][i / (n + 1) % (n + 1)], lines[2][i / (n + 1) / (n + 1)]};
    });
    scene.domain.lines = lines;
    return scene;
}

/// A grid whose inner cells are so small that all of them are within rounding, and not in line: only grids keep their
/// order where coordinates are rounded.
inline Scene cluster_of(float cell)
{
    std::vector<float> lines{-1};
    for (int i = 0; i < 5; ++i)
        lines.push_back(0.0625f + cell * static_cast<float>(i));
    lines.push_back(1);
    Scene scene = grid_of({lines, lines, lines});
    Random random(65);
    move_vertices(scene, [&](std::uint32_t i) {
        Float3 place = scene.tets.vertices[i];
        if (std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)}) == 1) return place;
        for (int axis = 0; axis < 3; ++axis)
            place[axis] = snap_to_grid(place[axis] + cell * random.between(-0.3f, 0.3f));
        return place;
    });
    return scene;
}

inline std::vector<float> even_lines(std::uint32_t n, float reach)
{
    std::vector<float> lines;
    for (std::uint32_t i = 0; i <= n; ++i)
        lines.push_back(snap_to_grid(reach * (2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f)));
    return lines;
}

/// Every other cell is so thin.
inline std::vector<float> uneven_lines(std::uint32_t n, float thickness)
{
    std::vector<float> lines = even_lines(n, 1);
    for (std::uint32_t i = 1; i < n; i += 2)
        lines[i + 1] = lines[i] + thickness;
    return lines;
}

struct HardScene {
    const char* name;
    Scene scene;
};

/// Meshes that are built to break a walk: points in planes, in lines and on spheres, stretched and thin tets.
inline std::vector<HardScene> make_hard_scenes()
{
    const auto fine = even_lines(8, 1), even = even_lines(4, 1);
    const auto thin = uneven_lines(4, 0x1p-18f);
    std::vector<HardScene> scenes;
    scenes.push_back({"regular", grid_of({fine, fine, fine})}); // coplanar; the corners of each cell lie on a sphere
    scenes.push_back({"jittered", make_cubes(5)});
    scenes.push_back({"stretched 1:10,000", grid_of({even, even, even_lines(4, 1e-4f)})});
    scenes.push_back({"slivers", grid_of({thin, thin, thin})});
    return scenes;
}

} // namespace tetrace::test
