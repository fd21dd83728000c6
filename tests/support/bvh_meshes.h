#pragma once

#include "core/bvh/bvh.h"
#include "tests/support/random.h"

#include <cmath>

namespace tetrace::test {

inline void add_triangle(TriangleMesh& mesh, Float3 a, Float3 b, Float3 c)
{
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Long, thin triangles through one another in all directions: their boxes overlap nearly everywhere.
inline TriangleMesh needles(std::uint32_t count)
{
    Random random(20);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Float3 a = random.point(-0.5f, 0.5f);
        const Float3 b = random.point(-0.5f, 0.5f);
        add_triangle(mesh, a, b, {b.x + 0.002f, b.y, b.z + 0.002f});
    }
    return mesh;
}

/// One triangle, again and again: nothing distinguishes them.
inline TriangleMesh identical_triangles(std::uint32_t count)
{
    TriangleMesh mesh;
    add_triangle(mesh, {0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0.25f});
    mesh.triangles.resize(count, mesh.triangles.front());
    return mesh;
}

/// Groups of 20 triangles, each group half (or so) as large as the one before, and a heap in the middle: trees by the
/// surface area heuristic become deep.
/// halvings: from one group to the next.
inline TriangleMesh nested_groups(int halvings, std::uint32_t groups, std::uint32_t heap)
{
    Random random(5);
    TriangleMesh mesh;
    for (std::uint32_t group = 0; group <= groups; ++group) {
        const float size = std::ldexp(1.0f, -halvings * static_cast<int>(group));
        const auto point = [&] {
            const float x = size * random.between(0.5f, 1), y = size * random.unit(), z = size * random.unit();
            return Float3{x, y, z};
        };
        for (std::uint32_t i = 0; i < (group < groups ? 20 : heap); ++i) {
            const Float3 a = point(), b = point(), c = point();
            add_triangle(mesh, a, b, c);
        }
    }
    return mesh;
}

/// The same in x, then within the last group in y, and within the last of those in z: the deepest trees by the
/// heuristic that we know how to provoke.
inline TriangleMesh nested_in_turn(int halvings, std::uint32_t triangles, std::uint32_t heap)
{
    Random random(5);
    TriangleMesh mesh;
    Float3 size = {1, 1, 1};
    const auto add_group = [&](int axis, std::uint32_t count) {
        const auto point = [&] {
            Float3 p;
            for (int i = 0; i < 3; ++i)
                p[i] = size[i] * (i == axis ? random.between(0.5f, 1) : random.unit());
            return p;
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            const Float3 a = point(), b = point(), c = point();
            add_triangle(mesh, a, b, c);
        }
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int group = 0; group < 120 / halvings; ++group) {
            add_group(axis, triangles);
            size[axis] = std::ldexp(size[axis], -halvings);
        }
    add_group(3, heap);
    return mesh;
}

/// Eight small triangles at the corners of a cube, in the order of x, then y, then z; the low corner first.
inline TriangleMesh cube_corners()
{
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        const Float3 a = {(i & 4) != 0 ? 0.5f : -0.5f, (i & 2) != 0 ? 0.5f : -0.5f, (i & 1) != 0 ? 0.5f : -0.5f};
        add_triangle(mesh, a, {a.x + 0.1f, a.y, a.z}, {a.x, a.y + 0.1f, a.z + 0.1f});
    }
    return mesh;
}

/// A tree with a leaf of triangle 0 at every level: `depth` inner nodes above the last, all in the same box.
inline Bvh chain(std::uint32_t depth, const Box& box)
{
    Bvh bvh;
    for (std::uint32_t i = 0; i < depth; ++i) {
        bvh.nodes.push_back({box, {2 * i + 1, 2 * i + 2}, 0, 0});
        bvh.nodes.push_back({box, {}, i, 1});
    }
    bvh.nodes.push_back({box, {}, depth, 1});
    bvh.references.resize(depth + 1);
    return bvh;
}

/// A tree and its mesh: `depth` levels, each with a leaf of one triangle that is lower, in z, than all that follow.
/// All have the same box but for z: a ray from above enters all, so that as many leaves wait on its stack. Each
/// triangle is in another of 8 x 8 cells, the lowest in all of them: whether a ray finds its triangle depends on one
/// entry.
struct DeepTree {
    TriangleMesh mesh;
    Bvh bvh;

    explicit DeepTree(std::uint32_t depth)
    {
        add_triangle(mesh, {-0.75f, -0.75f, -0.75f}, {0.75f, -0.75f, -0.75f}, {-0.75f, 0.75f, -0.75f});
        for (std::uint32_t i = 1; i <= depth; ++i) {
            const float x = static_cast<float>(i % 8) * 0.125f - 0.5f,
                        y = static_cast<float>(i / 8 % 8) * 0.125f - 0.5f;
            add_triangle(mesh, {x, y, height(i)}, {x + 0.125f, y, height(i)}, {x, y + 0.125f, height(i)});
        }
        for (std::uint32_t i = 0; i < depth; ++i) {
            bvh.nodes.push_back({{}, {2 * i + 1, 2 * i + 2}, 0, 0});
            bvh.nodes.push_back({box(i), {}, i, 1});
        }
        bvh.nodes.push_back({box(depth), {}, depth, 1});
        for (std::uint32_t i = 0; i <= depth; ++i)
            bvh.references.push_back(i);
        for (std::uint32_t i = depth; i-- > 0;)
            bvh.nodes[2 * i].box = merged(bvh.nodes[2 * i + 1].box, bvh.nodes[2 * i + 2].box);
    }

private:
    static float height(std::uint32_t i) { return -0.75f + 0x1p-7f * static_cast<float>(i); }
    static Box box(std::uint32_t i) { return {{-0.75f, -0.75f, height(i)}, {0.75f, 0.75f, height(i)}}; }
};

} // namespace tetrace::test
