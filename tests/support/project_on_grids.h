#pragma once

// Method project on layout tet96, compiled as host C++, on grids that are built to break a walk by projected signs; and
// rays through their vertices, edges and faces.

#include "bench/truth/settle.h"
#include "core/device/backend.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/random.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetrace::test {
namespace { // kernels of other sources have the same names

/// How many signs each level decided: products in float, what these lost, the rule for ties.
inline std::array<std::uint64_t, 3> decided{};
/// See COUNT_SEARCH in kernels/walks/entry_on_path.h.
inline std::array<std::uint64_t, 3> sought{};

#define COUNT_SIGN(level) (++decided[level])
#define COUNT_SEARCH(where) (++sought[where])
#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet96.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
namespace right {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_METHOD_HEADER

struct Grid {
    const char* name;
    Scene scene;
    PackedScene packed = pack(scene, Layout::tet96, TetOrder::chains);
    right::SceneView view = right::view_of(packed);
    ExactSearch search{scene.mesh};
    Settler settler{scene.mesh, search};

    Grid(const char* title, Scene made) : name(title), scene(std::move(made)) {}
    Grid(const Grid&) = delete;
};

inline const std::vector<std::unique_ptr<Grid>>& grids()
{
    static const auto made = [] {
        std::vector<std::unique_ptr<Grid>> list;
        for (auto& [name, scene] : make_hard_scenes())
            list.push_back(std::make_unique<Grid>(name, std::move(scene)));
        return list;
    }();
    return made;
}

struct Line {
    Float3 origin, direction;
};

inline Float3 along(Float3 a, Float3 b, float t)
{
    return snap_to_grid(Float3{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
}

/// A vertex, the middle of an edge, or a point of a face of some tet.
inline Float3 special_point(const Grid& grid, Random& random)
{
    const auto& mesh = grid.scene.tets;
    const auto& tet = mesh.tets[random.below(static_cast<std::uint32_t>(mesh.tets.size()))];
    const Float3 a = mesh.vertices[tet.vertices[0]], b = mesh.vertices[tet.vertices[1]],
                 c = mesh.vertices[tet.vertices[2]];
    switch (random.below(3)) {
    case 0: return a;
    case 1: return along(a, b, 0.5f);
    default: return along(along(a, b, 0.5f), c, 0.5f);
    }
}

inline Float3 without_small(Float3 direction)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) < 0x1p-20f) direction[axis] = 0;
    return direction;
}

/// Through two special points, or one and along an axis or a diagonal; never the zero vector.
inline Line line_through(const Grid& grid, Float3 point, Random& random)
{
    for (;;) {
        Float3 direction;
        if (random.below(2) == 0) {
            for (int axis = 0; axis < 3; ++axis)
                direction[axis] = static_cast<float>(random.below(3)) - 1.0f;
        } else {
            const Float3 other = special_point(grid, random);
            direction = without_small({other.x - point.x, other.y - point.y, other.z - point.z});
        }
        if (direction.x != 0 || direction.y != 0 || direction.z != 0) return {point, direction};
    }
}

/// Moved back along its direction until it starts outside the domain: by powers of two, which mostly keeps it exact.
inline Line from_outside(const Grid& grid, Line line)
{
    for (float back = 1; grid.scene.domain.contains(line.origin); back *= 2)
        line.origin =
            snap_to_grid(Float3{line.origin.x - back * line.direction.x, line.origin.y - back * line.direction.y,
                                line.origin.z - back * line.direction.z});
    return line;
}

inline bool is_in_range(const Line& line)
{
    return std::max({std::abs(line.origin.x), std::abs(line.origin.y), std::abs(line.origin.z)}) <= 4;
}

inline Hit to_hit(const right::Hit& hit)
{
    return {hit.face_id, hit.tet, hit.t, hit.u, hit.v, hit.steps};
}

inline right::TraceParams params_of(const Grid& grid, std::uint32_t start_tet)
{
    right::TraceParams params{};
    params.start_tet = start_tet;
    params.max_steps = step_cap(grid.packed.tet_count, {}); // the program's own
    return params;
}

inline Hit traced(const Grid& grid, const Line& line, std::uint32_t start_tet)
{
    const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
    return to_hit(right::trace(grid.view, params_of(grid, start_tet), ray));
}

/// The nearest triangle that the exact ray meets.
inline std::uint32_t nearest_triangle(const TriangleMesh& mesh, const Line& line)
{
    std::uint32_t nearest = NO_HIT;
    double t = HUGE_VAL;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const auto crossing =
            cross_exactly(line.origin, line.direction, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
        if (!crossing.met || crossing.t >= t) continue;
        nearest = i;
        t = crossing.t;
    }
    return nearest;
}

} // namespace
} // namespace tetrace::test
