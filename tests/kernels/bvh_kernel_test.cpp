// The BVH kernels against a loop over all triangles and against exact arithmetic, on meshes and rays that are hard for
// them.
#include "backends/embree/bvh_builder.h"
#include "core/bvh/bvh.h"
#include "core/pack/pack_bvh.h"
#include "tests/support/bvh_kernels.h"
#include "tests/support/bvh_meshes.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <utility>
#include <vector>
#ifdef __SSE2__
#include <immintrin.h>
#endif

using namespace tetrace;
using namespace tetrace::test;
using namespace tetrace::test::bvh;

namespace {

Ray ray_of(Float3 origin, Float3 direction)
{
    const auto clean = [](float a) { return flush_tiny(a); };
    return make_ray(to_vec3(origin), VEC3(clean(direction.x), clean(direction.y), clean(direction.z)));
}
Ray ray_to(Float3 origin, Float3 target)
{
    return ray_of(origin, {target.x - origin.x, target.y - origin.y, target.z - origin.z});
}

TraceParams params_for(bool any_hit)
{
    TraceParams params{};
    params.any_hit = any_hit ? 1 : 0;
    return params;
}

using Words = std::array<std::uint32_t, 6>;
Words bits_of(const bvh::Hit& hit)
{
    return std::bit_cast<Words>(hit);
}

/// A mesh in several trees.
struct Trees {
    explicit Trees(TriangleMesh of) : mesh(std::move(of)), split(build_bvh(mesh, 1).bvh) { pack(); }
    explicit Trees(const DeepTree& tree) : mesh(tree.mesh), split(tree.bvh) { pack(); }
    [[nodiscard]] bvh::Hit trace(std::size_t tree, const Ray& ray, float end = NO_END, bool any_hit = false) const
    {
        return trace_packed(packed[tree], params_for(any_hit), ray, end);
    }
    [[nodiscard]] std::array<Float3, 3> corners(std::uint32_t triangle) const
    {
        const auto& [a, b, c] = mesh.triangles[triangle];
        return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    }

    TriangleMesh mesh;
    Bvh split, balanced = build_balanced_bvh(mesh);
    std::vector<PackedScene> packed;

private:
    void pack()
    {
        for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh})
            for (const Bvh* tree : {&split, &balanced})
                packed.push_back(pack_bvh(mesh, *tree, layout));
    }
};

/// Only the triangle test, on all leaf triangles of a tree from the last to the first.
bvh::Hit trace_all(const PackedScene& packed, const Ray& ray, float end = NO_END)
{
    const SceneView view = view_of(packed);
    const RayFrame frame = frame_of(ray);
    Nearest nearest = no_hit_before(ray, end);
    for (std::size_t at = packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS; at-- > 0;)
        nearest = nearer_triangle(view, frame, nearest, static_cast<uint>(at));
    return hit_of(view, ray, nearest);
}

void expect_same_everywhere(const Trees& trees, const Ray& ray, float end = NO_END)
{
    const bvh::Hit expected = trace_all(trees.packed[0], ray, end);
    for (std::size_t tree = 0; tree < trees.packed.size(); ++tree) {
        ASSERT_EQ(bits_of(trees.trace(tree, ray, end)), bits_of(expected)) << "tree " << tree;
        const bvh::Hit any = trees.trace(tree, ray, end, true);
        ASSERT_EQ(any.face_id == NO_HIT, expected.face_id == NO_HIT) << "tree " << tree;
    }
}

/// A cube of half size 3/4 whose sides are cut into 2 n n triangles, its corners shared.
TriangleMesh cube(int n)
{
    TriangleMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    const auto vertex = [&](std::array<int, 3> at) {
        const auto [found, is_new] = numbers.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
        const auto line = [&](int i) { return 1.5f * static_cast<float>(i) / static_cast<float>(n) - 0.75f; };
        if (is_new) mesh.vertices.push_back({line(at[0]), line(at[1]), line(at[2])});
        return found->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (int side = 0; side <= n; side += n)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int di, int dj) {
                        std::array<int, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = i + di;
                        at[(axis + 2) % 3] = j + dj;
                        return vertex(at);
                    };
                    mesh.triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
                    mesh.triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
                }
    return mesh;
}

/// A closed mesh around the origin: the cube, each vertex moved along its own radius.
TriangleMesh boulder(int n, std::uint64_t seed)
{
    TriangleMesh mesh = cube(n);
    Random random(seed);
    for (Float3& v : mesh.vertices) {
        const double radius = random.between(0.5f, 1) / length(to_double(v));
        v = snap_to_grid(to_float(to_double(v) * radius));
    }
    return mesh;
}

/// Triangles that have nothing to do with each other; every second one is a needle, of an aspect down to 2^-20.
TriangleMesh soup(std::uint32_t count, std::uint64_t seed)
{
    TriangleMesh mesh;
    Random random(seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Float3 a = random.point(-0.9f, 0.9f), b = random.point(-0.9f, 0.9f);
        Float3 c = random.point(-0.9f, 0.9f);
        if (i % 2 == 1) {
            const float width = std::ldexp(1.0f, -static_cast<int>(random.below(21)));
            const auto near_b = [&](float from, float to) { return from + (to - from) * width; };
            c = snap_to_grid(Float3{near_b(b.x, c.x), near_b(b.y, c.y), near_b(b.z, c.z)});
        }
        mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

Float3 between(Float3 a, Float3 b, float share)
{
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share};
}

/// A vertex, a point of an edge, or one of a triangle.
Float3 point_of(const Trees& trees, Random& random)
{
    const auto [a, b, c] = trees.corners(random.below(static_cast<std::uint32_t>(trees.mesh.triangles.size())));
    const std::uint32_t kind = random.below(3);
    if (kind == 0) return a;
    const Float3 of_edge = between(a, b, random.unit());
    return kind == 1 ? of_edge : between(of_edge, c, random.unit());
}

class Meshes : public testing::TestWithParam<int> {
protected:
    static constexpr int needles = 3;
    static const Trees& trees()
    {
        static const std::vector<Trees> all = [] {
            std::vector<Trees> list;
            list.emplace_back(cube(1));
            list.emplace_back(cube(4));
            list.emplace_back(boulder(6, 1));
            list.emplace_back(soup(300, 2));
            return list;
        }();
        return all[static_cast<std::size_t>(GetParam())];
    }
};

} // namespace

TEST_P(Meshes, every_tree_gives_the_nearest_of_all_triangles_to_rays_that_are_aimed_at_them)
{
    Random random(11);
    for (int i = 0; i < 1500; ++i)
        ASSERT_NO_FATAL_FAILURE(
            expect_same_everywhere(trees(), ray_to(random.point(-4, 4), point_of(trees(), random))));
}

TEST_P(Meshes, every_tree_gives_the_nearest_of_all_triangles_to_rays_between_two_of_their_points)
{
    Random random(12);
    for (int i = 0; i < 1500; ++i) {
        const Float3 from = snap_to_grid(point_of(trees(), random));
        const float end = random.below(2) == 0 ? NO_END : random.between(0, 2);
        ASSERT_NO_FATAL_FAILURE(expect_same_everywhere(trees(), ray_to(from, point_of(trees(), random)), end));
    }
}

TEST_P(Meshes, rays_along_the_axes_are_answered_by_every_tree_alike)
{
    Random random(13);
    for (int i = 0; i < 600; ++i) {
        Float3 origin = random.below(2) == 0 ? point_of(trees(), random) : random.point(-1, 1);
        Float3 direction{};
        const int axis = static_cast<int>(random.below(3));
        direction[axis] = random.below(2) == 0 ? 1.0f : -1.0f;
        if (random.below(2) == 0) direction[(axis + 1) % 3] = random.between(-1, 1);
        origin[axis] = -2 * direction[axis];
        ASSERT_NO_FATAL_FAILURE(expect_same_everywhere(trees(), ray_of(snap_to_grid(origin), direction)));
    }
}

TEST_P(Meshes, the_first_exact_hit_is_found_but_for_rays_within_rounding_of_an_edge)
{
    Random random(14);
    int compared = 0;
    int differing = 0;
    for (int i = 0; i < 300; ++i) {
        const Float3 origin = random.point(-3, 3);
        const Ray ray = ray_to(origin, random.point(-0.7f, 0.7f));
        const Float3 direction{ray.direction.x, ray.direction.y, ray.direction.z};
        std::uint32_t first = NO_HIT;
        double t = NO_END;
        for (std::uint32_t triangle = 0; triangle < trees().mesh.triangles.size(); ++triangle) {
            const auto [a, b, c] = trees().corners(triangle);
            const auto crossing = cross_exactly(origin, direction, a, b, c);
            if (!crossing.met || crossing.t >= t) continue;
            first = triangle;
            t = crossing.t;
        }
        const bvh::Hit hit = trees().trace(0, ray);
        ++compared;
        differing += hit.face_id != first;
        if (hit.face_id == first && first != NO_HIT) {
            EXPECT_NEAR(hit.t, t, 1e-3 * t);
        }
    }
    EXPECT_LE(differing, compared / 100);
}

TEST_P(Meshes, a_ray_ends_after_its_hit_or_has_none)
{
    if (GetParam() == needles) return; // t of a needle is rounded by more than a hundredth
    Random random(15);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const Ray ray = ray_to(random.point(-3, 3), point_of(trees(), random));
        const bvh::Hit hit = trees().trace(0, ray);
        if (hit.face_id == NO_HIT || hit.t < 0.01f) continue;
        ++hits;
        for (std::size_t tree = 0; tree < trees().packed.size(); ++tree) {
            EXPECT_EQ(bits_of(trees().trace(tree, ray, hit.t * 1.01f)), bits_of(hit));
            EXPECT_EQ(trees().trace(tree, ray, hit.t * 0.99f).face_id, NO_HIT);
            EXPECT_EQ(trees().trace(tree, ray, 0).face_id, NO_HIT);
            EXPECT_EQ(trees().trace(tree, ray, hit.t * 0.99f, true).face_id, NO_HIT);
        }
    }
    EXPECT_GT(hits, 300);
}

#ifdef __SSE2__
TEST_P(Meshes, a_device_that_flushes_denormals_gives_the_same_bits)
{
    Random random(16);
    const unsigned kept = _mm_getcsr();
    for (int i = 0; i < 500; ++i) {
        const Ray ray = ray_to(snap_to_grid(random.point(-3, 3)), point_of(trees(), random));
        const Words expected = bits_of(trees().trace(0, ray));
        _mm_setcsr(kept | 0x8040); // flush to zero, denormals are zero
        const Words flushed = bits_of(trees().trace(0, ray));
        _mm_setcsr(kept);
        ASSERT_EQ(flushed, expected);
    }
}
#endif

INSTANTIATE_TEST_SUITE_P(each, Meshes, testing::Range(0, 4));

TEST(BvhKernel, a_tree_that_fills_the_stack_gives_the_nearest_of_all_triangles)
{
    const Trees trees(DeepTree{BVH2_STACK});
    Random random(17);
    int hits_of_lowest = 0;
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = ray_to({random.between(-0.25f, 0.25f), random.between(-0.25f, 0.25f), 1},
                               {random.between(-0.5f, 0.5f), random.between(-0.5f, 0.5f), -0.75f});
        ASSERT_NO_FATAL_FAILURE(expect_same_everywhere(trees, ray));
        hits_of_lowest += trees.trace(0, ray).face_id == 0;
    }
    EXPECT_GT(hits_of_lowest, 100) << "which wait longest";
}

TEST(BvhKernel, a_deep_tree_of_the_heuristic_gives_the_nearest_of_all_triangles)
{
    TriangleMesh mesh = nested_groups(1, 32, 20);
    for (Float3& vertex : mesh.vertices)
        vertex = snap_to_grid(vertex);
    const Trees trees(mesh);
    ASSERT_GT(depth_of(trees.split), 20u);
    Random random(18);
    for (int i = 0; i < 1000; ++i) // from the side of the smallest groups, so that the larger ones wait
        ASSERT_NO_FATAL_FAILURE(
            expect_same_everywhere(trees, ray_to(snap_to_grid(random.point(-0.25f, 0)), point_of(trees, random))));
}

TEST(BvhKernel, no_ray_from_inside_gets_out_through_a_vertex_or_an_edge)
{
    for (int shape = 0; shape < 3; ++shape) {
        const Trees trees(shape == 0 ? cube(3) : boulder(8, 20 + static_cast<std::uint64_t>(shape)));
        Random random(21);
        for (int i = 0; i < 3000; ++i) {
            const Float3 target = point_of(trees, random);
            const Ray ray = ray_to(random.point(-0.1f, 0.1f), target);
            for (std::size_t tree = 0; tree < trees.packed.size(); ++tree)
                ASSERT_NE(trees.trace(tree, ray).face_id, NO_HIT) << target.x << ' ' << target.y << ' ' << target.z;
        }
    }
}

TEST(BvhKernel, of_triangles_that_are_met_at_once_the_first_is_the_hit)
{
    TriangleMesh mesh = cube(2);
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto once = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    const Trees twice(mesh);
    Random random(22);
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = ray_to(random.point(-0.1f, 0.1f), point_of(twice, random));
        for (std::size_t tree = 0; tree < twice.packed.size(); ++tree)
            ASSERT_LT(twice.trace(tree, ray).face_id, count);
    }
    // The vertex in the middle of the side x = 3/4: all its triangles are met at t = 1.
    const bvh::Hit hit = twice.trace(0, ray_of({0, 0, 0}, {0.75f, 0, 0}));
    EXPECT_EQ(hit.t, 1);
    for (std::uint32_t triangle = 0; triangle < hit.face_id; ++triangle)
        for (const Float3 corner : twice.corners(triangle))
            EXPECT_FALSE((corner == Float3{0.75f, 0, 0}));
}

TEST(BvhKernel, a_ray_does_not_hit_what_it_starts_on)
{
    const Trees trees(cube(2));
    for (std::size_t tree = 0; tree < trees.packed.size(); ++tree) {
        EXPECT_EQ(trees.trace(tree, ray_of({0.75f, 0.25f, 0.125f}, {1, 0.25f, 0})).face_id, NO_HIT);
        EXPECT_EQ(trees.trace(tree, ray_of({0.75f, 0.25f, 0.125f}, {-1, 0, 0})).t, 1.5f);
    }
}

TEST(BvhKernel, a_ray_in_a_side_of_a_cube_meets_the_sides_that_it_runs_into)
{
    const Trees trees(cube(2));
    for (std::size_t tree = 0; tree < trees.packed.size(); ++tree) {
        EXPECT_EQ(trees.trace(tree, ray_of({-2, 0.25f, 0.75f}, {1, 0, 0})).t, 1.25f);
        EXPECT_EQ(trees.trace(tree, ray_of({-2, 0.25f, 0.75f + 0x1p-16f}, {1, 0, 0})).face_id, NO_HIT);
    }
}

TEST(BvhKernel, a_ray_without_a_direction_hits_nothing)
{
    const Trees trees(cube(1));
    for (std::size_t tree = 0; tree < trees.packed.size(); ++tree)
        EXPECT_EQ(trees.trace(tree, ray_of({0, 0, 0}, {0, 0, 0})).face_id, NO_HIT);
}

TEST(BvhKernel, the_side_of_an_edge_is_right_or_zero)
{
    Random random(23);
    int told = 0;
    for (int i = 0; i < 100000; ++i) {
        const Float3 a = random.point(-1, 1);
        const float scale = 1 + 0x1p-23f * static_cast<float>(random.below(8));
        const Sheared from{a.x, a.y};
        const Sheared to{a.x * scale, a.y * scale * (random.below(2) == 0 ? 1 : 1 + 0x1p-23f)};
        const double plus = double{from.x} * to.y; // exact
        const double minus = double{from.y} * to.x;
        const float side = fine_side(from, to);
        told += rough_side(from, to) == 0 && side != 0;
        ASSERT_TRUE(side == 0 || (side > 0) == (plus > minus));
        if (plus != minus) {
            ASSERT_NEAR(side / (plus - minus), 1, 1e-3);
        }
    }
    EXPECT_GT(told, 1000) << "nothing that the rough side leaves open";
}

TEST(BvhKernel, a_reciprocal_is_right_to_some_units_in_the_last_place)
{
    Random random(24);
    for (int i = 0; i < 100000; ++i) {
        const float a = std::ldexp(random.between(1, 2), static_cast<int>(random.below(180)) - 120);
        ASSERT_NEAR(double{a} * reciprocal(a), 1, 3 * 0x1p-24);
    }
}
