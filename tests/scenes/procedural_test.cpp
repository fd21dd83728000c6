#include "scenes/procedural.h"

#include "core/base/hash.h"
#include "core/mesh/entry_grid.h"
#include "scenes/catalogue.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Whether each edge is there exactly once in each direction.
::testing::AssertionResult closed_manifold(const TriangleMesh& mesh)
{
    std::set<Edge> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            if (!edges.insert({t[i], t[(i + 1) % 3]}).second)
                return ::testing::AssertionFailure() << "edge " << t[i] << " " << t[(i + 1) % 3] << " twice";
    for (const Edge& edge : edges)
        if (!edges.contains({edge.second, edge.first}))
            return ::testing::AssertionFailure() << "edge " << edge.first << " " << edge.second << " has one side only";
    return ::testing::AssertionSuccess();
}

/// Signed volume, positive where triangles are wound outwards.
double volume(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum +=
            dot(to_double(mesh.vertices[t[0]]), cross(to_double(mesh.vertices[t[1]]), to_double(mesh.vertices[t[2]]))) /
            6;
    return sum;
}

std::uint64_t hash_of_mesh(const TriangleMesh& mesh)
{
    return hash_of(mesh.triangles, hash_of(mesh.vertices));
}

Double3 size_of(const Domain& domain)
{
    return to_double(domain.high()) - to_double(domain.low());
}

} // namespace

TEST(Cubes, are_a_valid_tet_mesh_at_every_resolution)
{
    for (std::uint32_t n = 2; n <= 24; ++n) {
        const Scene scene = make_cubes(n);
        EXPECT_EQ(scene.tets.tets.size(), 6u * n * n * n);
        EXPECT_EQ(scene.tets.vertices.size(), (n + 1u) * (n + 1u) * (n + 1u));
        const auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
        EXPECT_FALSE(defect) << n << ": " << defect->what;
        const auto gap = find_gap(scene.tets, scene.mesh, size_of(scene.domain));
        EXPECT_FALSE(gap) << n << ": " << gap->what;
    }
}

TEST(Cubes, have_a_closed_ball_wound_outwards)
{
    for (std::uint32_t n = 3; n <= 24; ++n) {
        const Scene scene = make_cubes(n);
        EXPECT_TRUE(closed_manifold(scene.mesh)) << n;
        EXPECT_GT(volume(scene.mesh), 0) << n;
    }
    // Fine cubes come near the ball of radius 0.6; their number is what decides how near.
    EXPECT_NEAR(volume(make_cubes(24).mesh), 4.0 / 3 * 3.14159265 * 0.216, 0.05);
}

TEST(Cubes, have_one_face_per_triangle_and_boundary_faces_on_the_sides)
{
    for (const std::uint32_t n : {2u, 3u, 8u, 17u}) {
        const Scene scene = make_cubes(n);
        const TetMeshCounts counts = count_faces(scene.tets);
        EXPECT_EQ(counts.occlusive_faces, scene.mesh.triangles.size());
        EXPECT_EQ(counts.boundary_faces, 12u * n * n);
        EXPECT_EQ(2 * (counts.occlusive_faces + counts.free_faces) + counts.boundary_faces, 4 * counts.tets);
    }
}

TEST(Cubes, have_each_face_s_triangle_at_the_face_s_own_corners)
{
    const Scene scene = make_cubes(6);
    for (const Tet& tet : scene.tets.tets)
        for (std::size_t f = 0; f < 4; ++f) {
            if (tet.faces[f] == FREE_FACE) continue;
            std::set<std::uint64_t> of_face, of_triangle;
            const auto key = [](Float3 p) { return hash_of(std::vector<Float3>{p}); };
            for (std::size_t i = 0; i < 4; ++i)
                if (i != f) of_face.insert(key(scene.tets.vertices[tet.vertices[i]]));
            for (const std::uint32_t vertex : scene.mesh.triangles[tet.faces[f]])
                of_triangle.insert(key(scene.mesh.vertices[vertex]));
            EXPECT_EQ(of_face, of_triangle);
        }
}

TEST(Cubes, fill_their_domain_line_by_line)
{
    for (const std::uint32_t n : {2u, 7u, 16u}) {
        const Scene scene = make_cubes(n);
        EXPECT_EQ(scene.domain.divisions, n);
        EXPECT_EQ(scene.domain.low(), (Float3{-1, -1, -1}));
        EXPECT_EQ(scene.domain.high(), (Float3{1, 1, 1}));
        std::size_t faces = 0;
        const EntryGrid grid = make_entry_grid(scene.domain, scene.tets);
        for (std::uint32_t side = 0; side < 6; ++side)
            faces += faces_of_side(grid, side).size();
        EXPECT_EQ(faces, 12u * n * n);
        for (const Float3 vertex : scene.tets.vertices)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_EQ(vertex[axis] * 0x1p20f, std::round(vertex[axis] * 0x1p20f)) << "off the grid of 2^-20";
    }
}

TEST(Cubes, are_jittered_inside)
{
    const Scene scene = make_cubes(8);
    std::size_t on_lines = 0;
    for (const Float3 vertex : scene.tets.vertices)
        if (vertex.x * 4 == std::round(vertex.x * 4)) ++on_lines;
    EXPECT_EQ(scene.tets.vertices.size(), 729u);
    EXPECT_LT(on_lines, 729u - 330u); // 343 of them are inside
}

TEST(Cubes, are_the_same_bits_everywhere)
{
    EXPECT_EQ(hash_text(scene_hash(make_cubes(2))), "d2590671fff80ea8");
    EXPECT_EQ(hash_text(scene_hash(make_cubes(16))), "2c7031f527b55337");
    EXPECT_EQ(make_cubes(16), make_cubes(16));
}

TEST(Cubes, refuse_resolutions_outside_their_range)
{
    for (const std::uint32_t n : {0u, 1u, 129u, 0xFFFFFFFFu})
        EXPECT_TRUE(
            contains(error_of([&] { (void)make_cubes(n); }), "usage: making scene cubes: " + std::to_string(n)));
    EXPECT_EQ(make_cubes(128).tets.tets.size(), 12582912u);
}

TEST(Lattice, is_a_valid_tet_mesh_at_every_small_size)
{
    for (std::uint32_t n = min_lattice; n <= 20; ++n) {
        const Scene scene = make_lattice(n);
        EXPECT_EQ(scene.tets.tets.size(), lattice_tets(n));
        const auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
        EXPECT_FALSE(defect) << n << ": " << defect->what;
        const auto gap = find_gap(scene.tets, scene.mesh, size_of(scene.domain));
        EXPECT_FALSE(gap) << n << ": " << gap->what;
        EXPECT_EQ(find_weak_side(scene, make_entry_grid(scene.domain, scene.tets)), "") << n;
        EXPECT_GT(volume(scene.mesh), 0) << n;
    }
}

TEST(Lattice, has_as_many_solid_cubes_as_stop_a_line_after_half_its_length)
{
    // Four of 3 n cubes. A cube shows 1.5 sides to a line, so one of every n / 2 stops it. It has 12 triangles, but
    // where two meet; none is at the domain's sides.
    for (const double n : {24.0, 40.0}) {
        const double share = 4 / (3 * n), inside = (n - 2) * (n - 2) * (n - 2);
        const Scene scene = make_lattice(static_cast<std::uint32_t>(n));
        EXPECT_NEAR(static_cast<double>(scene.mesh.triangles.size()), 12 * inside * share * (1 - share),
                    0.05 * 12 * inside * share);
    }
}

TEST(Lattice, has_squares_of_several_cubes_if_there_are_more_than_128)
{
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "takes two minutes here; smaller lattices do not";
#endif
    const Scene scene = make_lattice(129);
    EXPECT_EQ(scene.domain.divisions, 65u);
    EXPECT_EQ(scene.domain.lines[0].size(), 66u);
    EXPECT_EQ(scene.domain.high(), (Float3{1, 1, 1}));
    EXPECT_EQ(find_weak_side(scene, make_entry_grid(scene.domain, scene.tets)), "");
    EXPECT_FALSE(find_defect(scene.tets, scene.mesh.triangles.size()));
}

TEST(Lattice, is_the_same_bits_everywhere)
{
    EXPECT_EQ(hash_text(scene_hash(make_lattice(16))), "3df268369dd2db15");
    EXPECT_EQ(make_lattice(16), make_lattice(16));
}

TEST(Lattice, refuses_sizes_outside_its_range)
{
    for (const std::uint32_t n : {0u, min_lattice - 1, max_lattice + 1})
        EXPECT_TRUE(contains(error_of([&] { (void)make_lattice(n); }), "usage: making scene lattice: "));
    EXPECT_LE(lattice_tets(max_lattice), MAX_TETS);
    EXPECT_GT(lattice_tets(max_lattice + 1), MAX_TETS);
    EXPECT_EQ(lattice_resolution("lattice:138"), 138u);
    EXPECT_EQ(lattice_resolution("lattice"), usual_lattice);
    EXPECT_EQ(lattice_resolution("lattices"), std::nullopt);
    for (const char* const name : {"lattice:", "lattice:x", "lattice:3", "lattice:564", "lattice:16.5", "lattice:-1"})
        EXPECT_TRUE(contains(error_of([&] { (void)lattice_resolution(name); }), "the number of its cubes")) << name;
}

TEST(Banana, is_closed_and_wound_outwards)
{
    const TriangleMesh banana = make_banana();
    EXPECT_EQ(banana.triangles.size(), 25000u);
    EXPECT_EQ(banana.vertices.size(), 12502u); // Euler: V - E + F = 2 with E = 3 F / 2
    EXPECT_TRUE(closed_manifold(banana));
    EXPECT_GT(volume(banana), 0.1);
}

TEST(Banana, has_no_double_vertex_and_no_flat_triangle)
{
    const TriangleMesh banana = make_banana();
    std::set<std::array<float, 3>> places;
    for (const Float3 p : banana.vertices)
        places.insert({p.x, p.y, p.z});
    EXPECT_EQ(places.size(), banana.vertices.size());
    for (const auto& t : banana.triangles) {
        const Double3 a = to_double(banana.vertices[t[0]]), b = to_double(banana.vertices[t[1]]),
                      c = to_double(banana.vertices[t[2]]);
        EXPECT_GT(length(cross(b - a, c - a)), 1e-8);
    }
}

TEST(Banana, bends_and_tapers)
{
    const TriangleMesh banana = make_banana();
    const auto depth_at = [&](std::size_t first) { // of the ring that starts there, across the plane of the arc
        float deepest = 0;
        for (std::size_t i = first; i < first + 100; ++i)
            deepest = std::max(deepest, banana.vertices[i].z);
        return deepest;
    };
    EXPECT_GT(depth_at(62 * 100), 1.5f * depth_at(20 * 100));
    EXPECT_GT(depth_at(62 * 100), 1.5f * depth_at(104 * 100));
    const Float3 tip = banana.vertices[12500], other_tip = banana.vertices[12501];
    EXPECT_LT(std::max(tip.x, other_tip.x), 0.7f); // the middle of the arc is at x = 1
}

TEST(Banana, is_closed_at_every_size_and_near_the_number_asked_for)
{
    for (const std::uint32_t triangles : {500u, 1'500u, 6'000u, 100'000u}) {
        const TriangleMesh banana = make_banana(triangles);
        EXPECT_NEAR(static_cast<double>(banana.triangles.size()), triangles, 0.13 * triangles);
        EXPECT_TRUE(closed_manifold(banana)) << triangles;
        EXPECT_NEAR(volume(banana), volume(make_banana()), 0.15 * volume(make_banana())) << triangles;
    }
}

TEST(Banana, of_any_size_has_no_needles)
{
    for (const std::uint32_t triangles : {1'500u, 25'000u, 100'000u}) {
        const TriangleMesh banana = make_banana(triangles);
        double shortest = 1, longest = 0;
        for (const auto& t : banana.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const Double3 from = to_double(banana.vertices[t[i]]), to = to_double(banana.vertices[t[(i + 1) % 3]]);
                shortest = std::min(shortest, length(to - from));
                longest = std::max(longest, length(to - from));
            }
        EXPECT_LT(longest, 6 * shortest) << triangles;
    }
}

TEST(Banana, is_the_same_bits_everywhere)
{
    EXPECT_EQ(hash_text(hash_of_mesh(make_banana())), "811b579e4b0cce82");
}
