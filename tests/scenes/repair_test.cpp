// Triangles that cross are cut along their exact intersections: what is left meets only in shared vertices and edges.
#include "scenes/builder/failure.h"
#include "scenes/builder/repair/repair.h"
#include "scenes/builder/repair/self_intersection.h"
#include "scenes/builder/repair/weld.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/random.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The mesh on the grid, with its numbers.
Scene scene_of(TriangleMesh mesh)
{
    Scene scene;
    for (Float3& v : mesh.vertices)
        v = snap_to_grid(v);
    scene.mesh = std::move(mesh);
    scene.origins.resize(scene.mesh.triangles.size());
    std::iota(scene.origins.begin(), scene.origins.end(), 0u);
    clean_up(scene.mesh, scene.origins);
    return scene;
}

Double3 normal_of(const TriangleMesh& mesh, std::size_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Double3 p = to_double(mesh.vertices[a]);
    return cross(to_double(mesh.vertices[b]) - p, to_double(mesh.vertices[c]) - p);
}

/// Twice the area of each triangle, as a vector along its normal.
std::vector<Double3> areas(const TriangleMesh& mesh, const std::vector<std::uint32_t>& origins, std::size_t count)
{
    std::vector<Double3> sums(count, Double3{0, 0, 0});
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        sums[origins[i]] = sums[origins[i]] + normal_of(mesh, i);
    return sums;
}

/// Repairs it, and expects pieces that meet in shared vertices and edges, turned and as large as their triangles.
/// Where triangles overlap in a plane, pieces belong to one of them: then areas are not compared.
Scene repaired(const TriangleMesh& mesh, bool overlap = false)
{
    Scene scene = scene_of(mesh);
    const std::size_t count = mesh.triangles.size();
    const auto before = areas(scene.mesh, scene.origins, count);
    repair(scene);
    EXPECT_TRUE(intersecting_pairs(scene.mesh).empty());
    EXPECT_EQ(scene.origins.size(), scene.mesh.triangles.size());
    const auto after = areas(scene.mesh, scene.origins, count);
    for (std::size_t i = 0; i < count && !overlap; ++i)
        EXPECT_LT(length(after[i] - before[i]), 1e-5) << "triangle " << i;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
        EXPECT_GT(dot(normal_of(scene.mesh, i), before[scene.origins[i]]), -1e-9) // rounding may turn a sliver
            << "piece " << i << " is turned";
    return scene;
}

bool has_vertex(const TriangleMesh& mesh, Float3 vertex)
{
    return std::find(mesh.vertices.begin(), mesh.vertices.end(), vertex) != mesh.vertices.end();
}

/// Edges with an odd number of triangles.
std::size_t open_edges(const TriangleMesh& mesh)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> counts;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++counts[std::minmax(triangle[i], triangle[(i + 1) % 3])];
    return static_cast<std::size_t>(
        std::count_if(counts.begin(), counts.end(), [](const auto& edge) { return edge.second % 2 != 0; }));
}

} // namespace

TEST(Repair, leaves_a_sound_mesh_unchanged)
{
    for (const TriangleMesh& mesh : {tetrahedron(), sphere(3), flat_cube(4)}) {
        const Scene before = scene_of(mesh);
        Scene scene = before;
        repair(scene);
        EXPECT_EQ(scene, before);
        EXPECT_EQ(scene.build.repair.passes, 0u);
    }
}

TEST(Repair, cuts_two_triangles_along_the_segment_that_they_share)
{
    const Scene scene = repaired(crossing_pair());
    EXPECT_EQ(scene.build.repair, (RepairInfo{false, 1, 2, 8, 0, 1, 0, 0}));
    EXPECT_EQ(std::count(scene.origins.begin(), scene.origins.end(), 0u), 5);
    EXPECT_EQ(std::count(scene.origins.begin(), scene.origins.end(), 1u), 3);
    EXPECT_TRUE(has_vertex(scene.mesh, {1.5f, 1, 0}));
    EXPECT_EQ(repair_text(scene.build), "1 pairs of triangles crossed: 2 triangles were cut into 8 pieces in 1 "
                                        "pass; 0 others lay on these or had no area after rounding, and were "
                                        "dropped");
}

TEST(Repair, cuts_every_way_in_which_two_triangles_meet)
{
    const std::vector<Float3> v = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1},  {1, 1, 0},
                                   {2, 1, 0}, {5, 5, 0}, {4, 4, 0}, {0, 0, 3},  {2, 0, 0}, {2, -1, 0}, {3, -1, 1}};
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    const auto pieces = [&](const Triangles& triangles, bool overlap = false) {
        return repaired({v, triangles}, overlap).mesh.triangles.size();
    };
    EXPECT_EQ(pieces({{0, 1, 2}, {6, 4, 5}}), 4u) << "a vertex inside the other";
    EXPECT_EQ(pieces({{0, 1, 2}, {11, 12, 13}}), 3u) << "a vertex on the other's edge";
    EXPECT_EQ(pieces({{0, 1, 2}, {6, 7, 4}}), 6u) << "an edge inside the other";
    EXPECT_GT(pieces({{0, 1, 2}, {0, 3, 4}}), 4u) << "from a shared vertex";
    EXPECT_GT(pieces({{0, 1, 2}, {6, 7, 8}}, true), 4u) << "overlap in a plane";
    EXPECT_EQ(pieces({{0, 1, 2}, {0, 1, 6}}, true), 3u) << "folded onto each other over an edge";
}

TEST(Repair, keeps_overlapping_faces_once)
{
    const TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                              {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
    const Scene both = repaired(square, true); // the same square, with either diagonal
    double area = 0;
    for (std::size_t i = 0; i < both.mesh.triangles.size(); ++i)
        area += normal_of(both.mesh, i).z / 2;
    EXPECT_DOUBLE_EQ(area, 1);
    const Scene boxes = repaired(joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0.25f, 0.25f}, {2, 0.75f, 0.625f})), true);
    EXPECT_GT(boxes.build.repair.dropped, 0u) << "their sides overlap";
}

TEST(Repair, gives_three_triangles_the_point_in_which_they_meet)
{
    const float r = 1.0f / 3;
    TriangleMesh planes{{{-1, -1, r},
                         {1, -1, r},
                         {0, 1.5f, r},
                         {r, -1, -1},
                         {r, 1, -1},
                         {r, 0, 1.5f},
                         {-1, r, -1},
                         {1, r, -1},
                         {0, r, 1.5f}},
                        {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
    const Scene scene = repaired(planes);
    EXPECT_TRUE(has_vertex(scene.mesh, {r, r, r}));
    EXPECT_EQ(scene.build.repair.crossing_pairs, 3u);
}

TEST(Repair, leaves_closed_surfaces_closed)
{
    const TriangleMesh two = joined(sphere(3), moved(sphere(3), {0.31f, 0.47f, 0.59f}, 0.9f));
    for (const TriangleMesh& mesh : {two, joined(two, moved(flat_cube(3), {-0.1f, -0.7f, 0.2f}))}) {
        const Scene scene = repaired(mesh);
        EXPECT_EQ(open_edges(scene.mesh), 0u);
        EXPECT_GT(scene.build.repair.cut_triangles, 50u);
        EXPECT_LE(scene.build.repair.passes, 3u);
    }
}

TEST(Repair, cleans_a_soup_of_triangles)
{
    Random random(19);
    const auto coordinate = [&] { return static_cast<float>(random.below(1u << 20)) * 0x1p-20f; };
    TriangleMesh soup;
    for (std::uint32_t i = 0; i < 40; ++i) {
        for (int corner = 0; corner < 3; ++corner)
            soup.vertices.push_back({coordinate(), coordinate(), coordinate()});
        soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    EXPECT_GT(repaired(soup).build.repair.crossing_pairs, 100u);
}

/// Polygons of one tilted plane, as fans: rounding takes their corners off it, so that they cross in all directions.
TriangleMesh decals(std::uint64_t seed, int polygons, double noise)
{
    Random random(seed);
    TriangleMesh all;
    for (int polygon = 0; polygon < polygons; ++polygon) {
        TriangleMesh fan;
        const double x0 = 0.6 * random.unit() - 0.3, y0 = 0.6 * random.unit() - 0.3, r = 0.2 + 0.4 * random.unit();
        for (int i = 0; i < 7; ++i) {
            const double angle = polygon + i * 6.28318530718 / 7, x = x0 + r * std::cos(angle),
                         y = y0 + r * std::sin(angle);
            fan.vertices.push_back(to_float(Double3{x, y, 0.3 * x + 0.7 * y + noise * random.unit()}));
        }
        for (std::uint32_t i = 2; i < 7; ++i)
            fan.triangles.push_back({0, i - 1, i});
        all = joined(all, fan);
    }
    return all;
}

TEST(Repair, welds_layers_whose_exact_cuts_have_no_end)
{
    int welded = 0;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        Scene scene = scene_of(decals(seed, 7, 1e-6));
        const auto before = areas(scene.mesh, scene.origins, scene.mesh.triangles.size());
        std::vector<std::string> told;
        repair(scene, 0, [&](const std::string& stage) { told.push_back(stage); });
        EXPECT_TRUE(intersecting_pairs(scene.mesh).empty()) << seed;
        const RepairInfo& info = scene.build.repair;
        EXPECT_TRUE(contains(told.at(0), "repairing, pass 1: ")) << "exactly at first";
        if (info.tolerance == 0) continue;
        ++welded;
        EXPECT_LE(info.tolerance, weld_tolerances.front());
        EXPECT_LE(info.moved, 1.5 * info.passes * info.tolerance);
        EXPECT_TRUE(contains(repair_text(scene.build), " was merged, and nothing moved by more than "));
        for (const Float3 v : scene.mesh.vertices) // nothing left the plane
            EXPECT_NEAR(v.z, 0.3f * v.x + 0.7f * v.y, 4e-6f) << seed;
        Double3 sum{};
        for (const Double3 area : before)
            sum = sum + area;
        double left = 0;
        for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
            left += length(normal_of(scene.mesh, i));
        EXPECT_LT(left, length(sum)) << "layers on each other were made one";
    }
    EXPECT_GT(welded, 0);
}

namespace {

/// Strips of one tilted plane that cross those of other directions, with heights that differ by rounding.
TriangleMesh strips(int directions, int count)
{
    Random random(1);
    TriangleMesh mesh;
    for (int direction = 0; direction < directions; ++direction)
        for (int strip = 0; strip < count; ++strip) {
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            const double low = -0.5 + static_cast<double>(strip) / count, high = low + 0.5 / count;
            for (const auto& [u, v] : {std::pair{-0.5, low}, {0.5, low}, {0.5, high}, {-0.5, high}}) {
                const double x = u * std::cos(direction) - v * std::sin(direction),
                             y = u * std::sin(direction) + v * std::cos(direction);
                mesh.vertices.push_back(to_float(Double3{x, y, 0.3 * x + 0.7 * y + 3e-8 * random.unit()}));
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
    return mesh;
}

} // namespace

TEST(Repair, leaves_exact_cuts_at_once_if_these_make_several_times_as_many_crossings)
{
    Scene scene = scene_of(strips(6, 10));
    std::vector<std::string> told;
    repair(scene, 0, [&](const std::string& stage) { told.push_back(stage); });
    EXPECT_TRUE(intersecting_pairs(scene.mesh).empty());
    EXPECT_GT(scene.build.repair.crossing_pairs, 1000u);
    ASSERT_GE(told.size(), 2u);
    EXPECT_TRUE(contains(told[1], fmt::format("a tolerance of {:.1e}, pass 1: ", weld_tolerances.front()))) << told[1];
}

TEST(Repair, finds_the_crossings_of_new_triangles_among_all)
{
    const TriangleMesh mesh = scene_of(strips(3, 10)).mesh;
    Random random(3);
    std::vector<bool> is_new(mesh.triangles.size());
    for (std::size_t i = 0; i < is_new.size(); ++i)
        is_new[i] = random.below(4) == 0;
    auto expected = intersecting_pairs(mesh);
    const std::size_t all = expected.size();
    std::erase_if(expected, [&](const auto& pair) { return !is_new[pair.first] && !is_new[pair.second]; });
    EXPECT_LT(expected.size(), all);
    EXPECT_EQ(intersecting_pairs(mesh, is_new), expected);
}

namespace {

/// Narrow leaves around an axis, that cross each other; each has 4 (rows - 1) triangles.
TriangleMesh leaves(std::uint64_t seed, std::uint32_t count, std::uint32_t rows)
{
    Random random(seed);
    TriangleMesh mesh;
    for (std::uint32_t leaf = 0; leaf < count; ++leaf) {
        const double turn = 2.4 * leaf, share = 0.1 + 0.9 * leaf / count, size = 0.25 - 0.16 * share;
        const Double3 root{0.01 * std::cos(turn), 0.5 * share, 0.01 * std::sin(turn)};
        const Double3 along = normalized({std::cos(turn), 0.3 + 0.6 * share + 0.4 * random.unit(), std::sin(turn)});
        const Double3 side = normalized({-std::sin(turn), random.between(-0.4f, 0.4f), std::cos(turn)});
        const double droop = random.between(0.2f, 0.8f);
        const auto add = [&](double s, double across) {
            const double width = 0.9 * s * (1 - s) * (1.5 - s);
            const Double3 up{0, 0.25 * width * across * across - droop * s * s, 0};
            const Double3 at = root + (along * s + side * (width * across) + up) * size;
            const auto few_digits = [](double x) { return static_cast<float>(std::nearbyint(x * 0x1p20) * 0x1p-20); };
            mesh.vertices.push_back({few_digits(at.x), few_digits(at.y), few_digits(at.z)});
        };
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size()), root_at = first + 3 * (rows - 1),
                   tip = root_at + 1, last = root_at - 3;
        for (std::uint32_t row = 1; row < rows; ++row)
            for (int across = -1; across <= 1; ++across)
                add(static_cast<double>(row) / rows, across);
        add(0, 0);
        add(1, 0);
        for (std::uint32_t i = 0; i < 2; ++i) {
            mesh.triangles.push_back({first + i, first + i + 1, root_at});
            mesh.triangles.push_back({last + i, last + i + 1, tip});
            for (std::uint32_t at = first + i; at < last; at += 3) {
                mesh.triangles.push_back({at, at + 1, at + 4});
                mesh.triangles.push_back({at, at + 4, at + 3});
            }
        }
    }
    return mesh;
}

} // namespace

// Only cutting these, or welding all of them, makes ever more slivers.
TEST(Repair, welds_only_what_still_crosses_after_cuts)
{
    std::size_t welded = 0;
    for (std::uint64_t seed = 4; seed < 6; ++seed) {
        Scene scene = scene_of(leaves(seed, 80, 100));
        std::set<std::uint32_t> crossing;
        for (const auto& [a, b] : intersecting_pairs(scene.mesh))
            crossing.insert({a, b});
        repair(scene);
        EXPECT_TRUE(intersecting_pairs(scene.mesh).empty()) << seed;
        const RepairInfo& info = scene.build.repair;
        EXPECT_LE(info.cut_triangles, crossing.size()) << "of no other triangle" << seed;
        EXPECT_LE(info.tolerance, local_tolerances.back()) << seed;
        EXPECT_LE(info.moved, 1.5 * info.tolerance * (info.passes / 2)) << seed;
        if (info.tolerance > 0) ++welded;
    }
    EXPECT_GT(welded, 0u);
}

TEST(Repair, welds_triangles_whose_edges_lose_their_length)
{
    Scene scene = scene_of(leaves(5, 80, 100));
    for (int pass = 0; pass < 3; ++pass) {
        weld(scene.mesh, scene.origins, weld_tolerances.front(), std::vector(scene.mesh.triangles.size(), true));
        EXPECT_EQ(scene.origins.size(), scene.mesh.triangles.size());
        clean_up(scene.mesh, scene.origins);
    }
    EXPECT_LT(intersecting_pairs(scene.mesh).size(), 100u);
}

TEST(Repair, welds_no_triangles_but_those_that_are_chosen)
{
    const TriangleMesh low{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const TriangleMesh two = joined(low, moved(low, {0.1f, 0.1f, 0x1p-22f})), far = moved(two, {4, 0, 0});
    TriangleMesh mesh = joined(two, far);
    std::vector<std::uint32_t> origins{0, 1, 2, 3};
    weld(mesh, origins, 0x1p-20, {false, false, true, true});
    EXPECT_EQ(std::ranges::count(origins, 0u), 1);
    EXPECT_EQ(std::ranges::count(origins, 1u), 1);
    EXPECT_GT(std::ranges::count(origins, 2u), 1);
    for (const Float3 vertex : two.vertices)
        EXPECT_TRUE(has_vertex(mesh, vertex));
}

TEST(Repair, welds_where_it_is_asked_to_though_no_triangles_cross)
{
    const TriangleMesh low{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const auto at_distance = [&](float distance) {
        Scene scene = scene_of(joined(low, moved(low, {0.1f, 0.1f, distance})));
        repair(scene, weld_tolerances.front());
        EXPECT_TRUE(intersecting_pairs(scene.mesh).empty());
        return scene;
    };
    const Scene near = at_distance(0x1p-22f), apart = at_distance(0x1p-10f);
    EXPECT_EQ(apart.mesh.triangles.size(), 2u);
    EXPECT_GT(near.mesh.triangles.size(), 4u);
    EXPECT_GT(near.build.repair.dropped, 0u);
    double area = 0;
    for (std::size_t i = 0; i < near.mesh.triangles.size(); ++i)
        area += normal_of(near.mesh, i).z / 2;
    EXPECT_NEAR(area, 1 - 0.8 * 0.8 / 2, 1e-5) << "what both cover is there once";
}

TEST(Repair, welds_vertices_that_are_nearly_one)
{
    const float gap = 0x1p-23f;
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, gap, 0}, {gap, 1, gap}, {1, 1, 0.5f}},
                            {{0, 1, 2}, {3, 5, 4}}};
    Scene scene = scene_of(mesh);
    repair(scene, weld_tolerances.front());
    EXPECT_EQ(scene.mesh.vertices, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}}));
    EXPECT_EQ(scene.mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Repair, welds_a_vertex_to_the_edge_that_it_nearly_touches)
{
    const float gap = 0x1p-23f;
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5f, -1, 0}, {0.4f, gap, 0}, {0.3f, 1, 0.5f}, {0.6f, 1, -0.5f}},
                            {{0, 1, 2}, {3, 4, 5}}};
    Scene scene = scene_of(mesh);
    repair(scene, weld_tolerances.front());
    EXPECT_EQ(scene.mesh.triangles.size(), 3u) << "the neighbouring triangle is cut there";
    EXPECT_EQ(scene.mesh.vertices.size(), 6u);
    EXPECT_EQ(scene.origins, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(Repair, gives_up_where_no_tolerance_is_left)
{
    Scene scene = scene_of(decals(1, 2, 1e-3));
    scene.build.source = "flat.off";
    const Scene before = scene;
    try {
        repair(scene, 2 * weld_tolerances.back());
        ADD_FAILURE() << repair_text(scene.build);
    } catch (const BuilderFailure& failure) {
        EXPECT_EQ(failure.code(), BUILDER_SELF_INTERSECTION);
        EXPECT_TRUE(contains(failure.what(), "repairing flat.off: "));
        EXPECT_TRUE(contains(failure.what(), "in another program"));
    }
    EXPECT_EQ(scene, before);
}
