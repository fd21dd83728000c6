#include "backends/embree/bvh_builder.h"

#include "core/base/error.h"
#include "core/bvh/bvh.h"
#include "kernels/layouts/layout.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <limits>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::uint32_t max_leaf(const Bvh& bvh)
{
    std::uint32_t largest = 0;
    for (const auto& node : bvh.nodes)
        largest = std::max(largest, node.count);
    return largest;
}

/// By the surface area heuristic, a node's boxes as dear as a triangle.
double cost_of(const Bvh& bvh)
{
    double cost = 0;
    for (const auto& node : bvh.nodes)
        cost += half_area(node.box) * (node.count > 0 ? node.count : 1);
    return cost / half_area(bvh.nodes.front().box);
}

} // namespace

TEST(BvhBuilder, tree_of_a_surface_is_whole)
{
    const TriangleMesh mesh = make_cubes(8).mesh;
    const BuiltBvh built = build_bvh(mesh);
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_EQ(built.fall_back, "");
    EXPECT_LE(depth_of(built.bvh), BVH2_STACK);
    EXPECT_LE(max_leaf(built.bvh), 4u);
}

TEST(BvhBuilder, needles_are_split)
{
    const TriangleMesh mesh = needles(500);
    const BuiltBvh built = build_bvh(mesh);
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_GT(built.spatial_splits, 50u);
    EXPECT_EQ(built.bvh.references.size(), 500 + built.spatial_splits);
    EXPECT_EQ(built.fall_back, "");
}

// Where a triangle was cut, each of its leaves may leave out what is in others, and nothing else.
TEST(BvhBuilder, each_point_of_a_split_triangle_is_in_one_of_its_leaves)
{
    const TriangleMesh mesh = needles(500);
    const Bvh bvh = build_bvh(mesh).bvh;
    std::vector<std::vector<Box>> leaves(mesh.triangles.size());
    for (const auto& node : bvh.nodes)
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            leaves[bvh.references[i]].push_back(grown(node.box, 0x1p-22)); // the point below is rounded
    Random random(4);
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        for (int i = 0; i < 20; ++i) {
            const auto& [a, b, c] = mesh.triangles[triangle];
            const float u = random.unit();
            const Float3 point = to_float(to_double(mesh.vertices[a]) * (1 - u) +
                                          (to_double(mesh.vertices[b]) + to_double(mesh.vertices[c])) * (0.5 * u));
            EXPECT_TRUE(std::any_of(leaves[triangle].begin(), leaves[triangle].end(),
                                    [&](const Box& box) {
                                        return contains(box, {point, point});
                                    }))
                << "triangle " << triangle;
        }
    }
}

TEST(BvhBuilder, tree_does_not_depend_on_the_threads)
{
    const TriangleMesh mesh = needles(600);
    const Bvh one = build_bvh(mesh, 1).bvh;
    for (const unsigned threads : {0u, 2u})
        EXPECT_EQ(build_bvh(mesh, threads).bvh, one) << threads << " threads";
}

TEST(BvhBuilder, tree_is_cheaper_than_one_halved_by_numbers)
{
    const TriangleMesh mesh = needles(500);
    EXPECT_LT(cost_of(build_bvh(mesh).bvh), 0.85 * cost_of(build_balanced_bvh(mesh)));
}

TEST(BvhBuilder, equal_triangles_are_divided_evenly)
{
    const TriangleMesh mesh = identical_triangles(10'000);
    const Bvh bvh = build_bvh(mesh).bvh;
    EXPECT_EQ(find_defect(bvh, mesh), std::nullopt);
    EXPECT_LE(depth_of(bvh), 16u);
    EXPECT_LE(max_leaf(bvh), 4u);
}

TEST(BvhBuilder, triangles_without_area_are_kept)
{
    TriangleMesh mesh;
    for (int i = 0; i < 500; ++i) {
        const float x = static_cast<float>(i) * 0x1p-10f;
        add_triangle(mesh, {x, x, x}, {x + 0.5f, x + 0.5f, x + 0.5f}, {x + 0.25f, x + 0.25f, x + 0.25f}); // a line
        add_triangle(mesh, {x, 0, 0}, {x, 0, 0}, {x, 0, 0});                                              // a point
    }
    EXPECT_EQ(find_defect(build_bvh(mesh).bvh, mesh), std::nullopt);
}

TEST(BvhBuilder, one_triangle_is_one_leaf)
{
    const TriangleMesh mesh = identical_triangles(1);
    const BuiltBvh built = build_bvh(mesh);
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_EQ(built.bvh.nodes.size(), 1u);
    EXPECT_EQ(built.spatial_splits, 0u);
}

TEST(BvhBuilder, tree_that_would_be_too_deep_is_balanced_instead)
{
    const TriangleMesh mesh = nested_groups(2, 58, 5000);
    const BuiltBvh built = build_bvh(mesh, 0, 32);
    EXPECT_NE(built.fall_back.find("more than 32 nodes"), std::string::npos) << built.fall_back;
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_LE(depth_of(built.bvh), 16u);
    EXPECT_LE(max_leaf(built.bvh), 4u);
}

TEST(BvhBuilder, deep_trees_are_the_heuristics_and_fit_the_stack)
{
    for (const int halvings : {1, 2, 3, 6}) {
        const TriangleMesh mesh = nested_groups(halvings, 36 / halvings, 1000);
        const BuiltBvh built = build_bvh(mesh);
        EXPECT_EQ(built.fall_back, "") << halvings;
        EXPECT_LE(depth_of(built.bvh), BVH2_STACK);
        EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    }
}

// All were halved by number when the stack had 32 entries.
TEST(BvhBuilder, the_deepest_trees_that_we_know_to_provoke_fit_the_stack)
{
    for (const TriangleMesh& mesh :
         {nested_groups(2, 58, 5000), nested_in_turn(4, 5, 5), nested_in_turn(5, 20, 1000)}) {
        const BuiltBvh built = build_bvh(mesh);
        EXPECT_EQ(built.fall_back, "");
        EXPECT_GT(depth_of(built.bvh), 32u);
        EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    }
}

TEST(BvhBuilder, sizes_down_to_denormals_are_built)
{
    for (const int exponent : {-30, -60, -100, -120, -126, -140}) {
        TriangleMesh mesh = needles(100);
        for (auto& vertex : mesh.vertices)
            for (int axis = 0; axis < 3; ++axis)
                vertex[axis] = std::ldexp(vertex[axis], exponent);
        add_triangle(mesh, {-64, -64, -64}, {64, 64, 64}, {64, -64, 64});
        const Bvh bvh = build_bvh(mesh).bvh;
        EXPECT_EQ(find_defect(bvh, mesh), std::nullopt) << "2^" << exponent;
        mesh.triangles.pop_back();
        EXPECT_EQ(find_defect(build_bvh(mesh).bvh, mesh), std::nullopt) << "2^" << exponent;
    }
}

namespace {

ErrorKind refusal_of(const TriangleMesh& mesh)
{
    try {
        (void)build_bvh(mesh);
    } catch (const Error& error) {
        return error.kind();
    }
    return ErrorKind::internal;
}

} // namespace

TEST(BvhBuilder, meshes_that_cannot_be_built_are_refused)
{
    const TriangleMesh good = identical_triangles(2);
    EXPECT_EQ(refusal_of({}), ErrorKind::invalid_input);
    TriangleMesh beyond = good;
    beyond.triangles[1][2] = 3;
    EXPECT_EQ(refusal_of(beyond), ErrorKind::invalid_input);
    for (const float x :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f, -65.0f}) {
        TriangleMesh far = good;
        far.vertices[1].y = x;
        EXPECT_EQ(refusal_of(far), ErrorKind::invalid_input) << x;
    }
    TriangleMesh unused = good;
    unused.vertices.push_back({1e30f, 0, 0}); // which no triangle has
    EXPECT_EQ(find_defect(build_bvh(unused).bvh, unused), std::nullopt);
}

TEST(BvhBuilder, leaves_the_rounding_as_it_was)
{
    const volatile float tiny = std::numeric_limits<float>::min();
    std::fesetround(FE_UPWARD);
    (void)build_bvh(needles(100));
    const int rounding = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(rounding, FE_UPWARD);
    EXPECT_GT(tiny / 2, 0.0f) << "denormals are flushed";
}
