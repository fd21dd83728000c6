// What the builder does to a mesh before TetGen: clean it, place it in the domain, refuse one that meets itself.
#include "scenes/builder/build.h"
#include "scenes/builder/repair/repair.h"
#include "scenes/builder/repair/self_intersection.h"
#include "scenes/catalogue.h"
#include "tests/support/builder_meshes.h"

#include <cmath>

using namespace tetrace;
using namespace tetrace::test;

TEST(CleanUp, counts_what_it_takes_away)
{
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, -0.0f}, {2, 0, 0}, {9, 9, 9}, {0, 0, 1}},
                      {{0, 1, 2}, {2, 3, 1}, {0, 1, 4}, {0, 3, 1}, {1, 2, 6}}};
    const CleanUp cleaned = clean_up(mesh);
    EXPECT_EQ(cleaned, (CleanUp{1, 2, 2, 1}));
    EXPECT_EQ(mesh, (TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 2, 3}}}));
    EXPECT_EQ(clean_up(mesh), CleanUp{}) << "a clean mesh stays";
}

TEST(CleanUp, distinguishes_thin_triangles_from_collinear_ones_exactly)
{
    const float up = std::nextafter(2.0f, 3.0f);
    TriangleMesh mesh{{{0, 0, 0}, {1, 1, 1e-30f}, {2, 2, 2e-30f}, {2, up, 2e-30f}}, {{0, 1, 2}, {0, 1, 3}}};
    EXPECT_EQ(clean_up(mesh).degenerate_triangles, 1u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(Place, scales_by_a_power_of_two_and_loses_nothing)
{
    for (const DomainKind kind : {DomainKind::tight, DomainKind::wide}) {
        for (const float size : {1e-30f, 3e-4f, 0.96f, 1.0f, 77.0f, 1e30f}) {
            TriangleMesh mesh = sphere(2);
            for (Float3& v : mesh.vertices)
                v = {v.x * size, v.y * size, v.z * size};
            const TriangleMesh before = mesh;
            const Placement placement = place(mesh, kind);
            EXPECT_EQ(placement.snapped_coordinates, 0u);
            for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_EQ(std::ldexp(mesh.vertices[i][axis], -placement.scale_exponent), before.vertices[i][axis]);
            const Domain domain = make_domain(mesh, kind, 8);
            float reach = 0;
            for (int axis = 0; axis < 3; ++axis)
                reach = std::max({reach, -domain.low()[axis], domain.high()[axis]});
            EXPECT_LE(reach, 1) << size;
            EXPECT_GT(reach, 0.5f) << size;
        }
    }
}

TEST(Place, counts_the_coordinates_that_the_grid_rounds)
{
    TriangleMesh mesh = tetrahedron();
    mesh.vertices[0] = {0x1.8p-45f, 0x1p-30f, 0};
    EXPECT_EQ(place(mesh, DomainKind::tight).snapped_coordinates, 1u);
    EXPECT_EQ(mesh.vertices[0].x, 0);
}

TEST(SelfIntersection, finds_none_in_sound_meshes)
{
    EXPECT_EQ(find_self_intersections(tetrahedron()).count, 0u);
    EXPECT_EQ(find_self_intersections(sphere(3)).count, 0u);
    EXPECT_EQ(find_self_intersections(flat_cube(5)).count, 0u);
}

TEST(SelfIntersection, finds_none_in_the_catalogue_s_procedural_meshes_but_the_plant)
{
    for (const CatalogueEntry& row : catalogue())
        for (const std::uint32_t triangles : {row.procedural ? row.procedural->least : 0, 9'000u, 40'000u})
            if (row.procedural && row.procedural->make != nullptr) {
                TriangleMesh mesh = row.procedural->make(triangles);
                EXPECT_EQ(clean_up(mesh), CleanUp{}) << row.name << " in " << triangles;
                place(mesh, DomainKind::tight);
                EXPECT_EQ(find_self_intersections(mesh).count > 0, row.name == "plant")
                    << row.name << " in " << triangles;
            }
}

TEST(SelfIntersection, finds_every_way_in_which_two_triangles_meet)
{
    const std::vector<Float3> v = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1},
                                   {1, 1, 0}, {2, 1, 0}, {5, 5, 0}, {4, 4, 0},  {0, 0, 3}};
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    const auto count = [&](const Triangles& triangles) { return find_self_intersections({v, triangles}).count; };
    EXPECT_EQ(count({{0, 1, 2}, {3, 4, 5}}), 1u) << "crossing";
    EXPECT_EQ(count({{0, 1, 2}, {6, 4, 5}}), 1u) << "a vertex inside the other";
    EXPECT_EQ(count({{0, 1, 2}, {6, 7, 8}}), 1u) << "overlap in a plane";
    EXPECT_EQ(count({{0, 1, 2}, {0, 3, 4}}), 1u) << "the second's far edge through the first";
    EXPECT_EQ(count({{0, 3, 4}, {0, 1, 2}}), 1u) << "the first's far edge through the second";
    EXPECT_EQ(count({{0, 1, 2}, {0, 6, 10}}), 1u) << "along an edge from a shared vertex";
    EXPECT_EQ(count({{0, 1, 2}, {0, 1, 6}}), 1u) << "folded onto each other over an edge";
    EXPECT_EQ(count({{0, 1, 2}, {1, 2, 9}}), 0u) << "neighbours in a plane";
    EXPECT_EQ(count({{0, 1, 2}, {0, 1, 10}}), 0u) << "neighbours over an edge";
    EXPECT_EQ(count({{0, 1, 2}, {1, 8, 9}}), 0u) << "a shared vertex only";
    EXPECT_EQ(count({{0, 1, 2}, {4, 5, 10}}), 0u) << "apart";
}

TEST(SelfIntersection, lists_the_first_pairs_in_mesh_units)
{
    TriangleMesh mesh = crossing_pair();
    for (std::uint32_t i = 0; i < 8; ++i) {
        mesh.triangles.push_back({3, 4, static_cast<std::uint32_t>(mesh.vertices.size())});
        mesh.vertices.push_back({2, 1 + 0.1f * static_cast<float>(i + 1), 1});
    }
    const auto found = find_self_intersections(mesh, 3);
    EXPECT_EQ(found.count, 9u);
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    EXPECT_EQ(found.first, (std::vector<Pair>{{0, 1}, {0, 2}, {0, 3}}));
    Scene scene;
    scene.mesh = mesh;
    scene.build.scale_exponent = 1;
    scene.origins = {7, 8, 9, 10};
    const std::string text = describe(found, scene);
    EXPECT_TRUE(contains(text, "triangle 8 (0.5, 0.5, -0.5) (0.5, 0.5, 0.5) (1, 0.5, 0.5)"));
    EXPECT_TRUE(contains(text, "a repair (without --no-repair) cuts them"));
}
