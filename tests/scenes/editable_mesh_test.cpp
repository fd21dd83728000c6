// The mesh under the optimiser: replacing tets is refused unless the result is the same tetrahedralization but for its
// free faces; and each operation on it lowers the cost by what it says.
#include "scenes/optimise/collapse.h"
#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/insertion.h"
#include "scenes/optimise/vertex_move.h"
#include "scenes/procedural.h"
#include "tests/scenes/edited_mesh.h"
#include "tests/support/random.h"
#include "tests/support/sound_tets.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

// n tets around the edge from (0, 0, -1/2) to (0, 0, 1/2), in a box of no more: each has an occlusive or boundary face.
TetMesh fan(std::uint32_t n, Random& random)
{
    TetMesh mesh{{{0, 0, -0.5f}, {0, 0, 0.5f}}, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n, radius = 0.3 + 0.4 * random.unit();
        mesh.vertices.push_back(
            snap_to_grid(to_float({radius * std::cos(angle), radius * std::sin(angle), 0.2 * random.unit() - 0.1})));
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t next = (i + 1) % n, last = (i + n - 1) % n;
        // (1, 0, ring i, ring i + 1) is positive: faces 3 and 2 are shared with the tets before and after.
        mesh.tets.push_back({{1, 0, 2 + i, 2 + next},
                             {NO_HALF_FACE, NO_HALF_FACE, make_half_face(next, 3), make_half_face(last, 2)},
                             {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    }
    return mesh;
}

std::uint32_t free_vertex(const EditableMesh& mesh)
{
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v)
        if (mesh.is_free(v) && mesh.box_sides(v) == 0) return v;
    return NO_TET;
}

} // namespace

TEST(EditableMesh, gives_back_the_mesh_that_it_was_given)
{
    EXPECT_EQ(EditableMesh(cubes().tets).take(), cubes().tets);
}

TEST(EditableMesh, knows_what_rays_reach_and_what_may_move)
{
    const EditableMesh mesh(cubes().tets);
    std::size_t reached = 0, free = 0;
    for (std::uint32_t t = 0; t < mesh.tet_slots(); ++t)
        reached += mesh.is_reached(t) ? 1 : 0;
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
        free += mesh.is_free(v) ? 1 : 0;
        const Double3 p = mesh.point(v), low = to_double(cubes().domain.low()), high = to_double(cubes().domain.high());
        const BoxSides sides = (p.x == low.x ? 1u : 0u) | (p.x == high.x ? 2u : 0u) | (p.y == low.y ? 4u : 0u) |
                               (p.y == high.y ? 8u : 0u) | (p.z == low.z ? 16u : 0u) | (p.z == high.z ? 32u : 0u);
        EXPECT_EQ(mesh.box_sides(v), sides);
        if (sides == 0) continue;
        EXPECT_EQ(mesh.is_free(v), std::popcount(sides) < 3) << "all but the corners";
    }
    EXPECT_GT(reached, 0U);
    EXPECT_LT(reached, mesh.tet_slots()); // the ball is closed
    EXPECT_GT(free, 0U);
}

TEST(EditableMesh, refuses_what_is_no_tetrahedralization_and_changes_nothing)
{
    EditableMesh mesh(cubes().tets);
    const std::uint32_t v = free_vertex(mesh);
    VertexStar star;
    ASSERT_TRUE(find_star(mesh, v, 400, star));
    std::vector<Corners> same;
    for (const std::uint32_t t : star.tets)
        same.push_back(mesh.tet(t).vertices);
    const auto refused = [&](std::span<const std::uint32_t> old, const std::vector<Corners>& fresh) {
        const bool done = mesh.replace(old, fresh);
        return !done && mesh.take() == cubes().tets;
    };
    auto fresh = same;
    fresh.pop_back();
    EXPECT_TRUE(refused(star.tets, fresh)) << "a hole";
    fresh = same;
    fresh.push_back(same.front());
    EXPECT_TRUE(refused(star.tets, fresh)) << "one tet twice";
    fresh = same;
    std::swap(fresh.front()[0], fresh.front()[1]);
    EXPECT_TRUE(refused(star.tets, fresh)) << "an inverted tet";
    fresh = same;
    fresh.front()[0] = fresh.front()[1];
    EXPECT_TRUE(refused(star.tets, fresh)) << "a flat tet";
    auto twice = star.tets;
    twice.push_back(twice.front());
    EXPECT_TRUE(refused(twice, same)) << "an old tet named twice";
    for (std::uint32_t t = 0; t < mesh.tet_slots(); ++t) {
        if (mesh.is_reached(t)) continue;
        const std::array<std::uint32_t, 1> hidden = {t};
        EXPECT_TRUE(refused(hidden, {mesh.tet(t).vertices})) << "a tet inside a closed object";
        break;
    }
    EXPECT_TRUE(mesh.replace(star.tets, same)) << "the same again is sound";
    EXPECT_EQ(corners_of(mesh), corners_of(EditableMesh(cubes().tets)));
}

TEST(EditableMesh, refuses_moves_that_invert_a_tet)
{
    EditableMesh mesh(cubes().tets);
    const std::uint32_t v = free_vertex(mesh);
    VertexStar star;
    ASSERT_TRUE(find_star(mesh, v, 400, star));
    const Double3 from = mesh.point(v);
    EXPECT_FALSE(mesh.move(v, star.tets, from + Double3{0.5, 0.5, 0.5}));
    EXPECT_FALSE(mesh.move(v, star.tets, mesh.point(star.edges.front().p))) << "onto a neighbour";
    EXPECT_EQ(mesh.take(), cubes().tets);
}

TEST(TetShape, is_positive_only_with_the_orientation_of_the_meshes_and_some_height)
{
    const Double3 a{0, 0, 0}, b{0, 0.5, 0}, c{0.5, 0, 0}, d{0, 0, 0.5};
    EXPECT_TRUE(may_be_made(a, b, c, d));
    EXPECT_FALSE(may_be_made(b, a, c, d));
    EXPECT_FALSE(may_be_made(a, b, c, {0.25, 0.25, 0})) << "flat";
    EXPECT_FALSE(may_be_made(a, b, c, {0.25, 0.25, 0x1p-40})) << "positive, but too thin";
    EXPECT_FALSE(may_be_made(a, b, c, {0.25, 0.25, 5e-4}));
    EXPECT_TRUE(may_be_made(a, b, c, {0.25, 0.25, 1e-3}));
}

TEST(EdgeRemoval, finds_the_cheapest_of_all_triangulations_of_the_ring)
{
    Random random(1);
    int removed = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const std::uint32_t n = 3 + static_cast<std::uint32_t>(trial) % 6;
        EditableMesh mesh(fan(n, random));
        EdgeRing ring;
        ASSERT_TRUE(find_ring(mesh, 0, 0, max_around_edge, from_any_tet, ring));
        ASSERT_EQ(ring.tets.size(), n);
        const double before = mesh.cost(), expected = cheapest(mesh, ring, 0, n - 1);
        const double gain = EdgeRemoval(mesh).try_edge(0, 0, anything);
        if (expected == impossible) {
            EXPECT_EQ(gain, 0);
            continue;
        }
        ++removed;
        EXPECT_NEAR(mesh.cost(), expected, 1e-12);
        EXPECT_NEAR(before - mesh.cost(), gain, 1e-12);
        EXPECT_EQ(mesh.take().tets.size(), 2 * (n - 2));
        EXPECT_FALSE(find_defect(mesh.take(), 0));
    }
    EXPECT_GT(removed, 100);
}

TEST(EdgeRemoval, is_undone_by_face_removal)
{
    Random random(2);
    const TetMesh start = fan(3, random);
    EditableMesh mesh(start);
    const double gain = EdgeRemoval(mesh).try_edge(0, 0, anything);
    ASSERT_NE(gain, 0);
    double back = 0;
    for (std::uint32_t face = 0; face < 4 && back == 0; ++face)
        back = try_face(mesh, 0, face, anything);
    EXPECT_NEAR(back, -gain, 1e-12);
    EXPECT_EQ(corners_of(mesh), corners_of(EditableMesh(start)));
}

TEST(VertexMove, ends_where_no_other_point_is_cheaper)
{
    EditableMesh mesh(cubes().tets);
    const std::uint32_t v = free_vertex(mesh);
    VertexStar star;
    ASSERT_TRUE(find_star(mesh, v, 400, star));
    const Double3 best = cheapest_point(mesh, star.edges, 0, mesh.point(v), 500);
    const double least = star.cost(mesh, best);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const double reach = std::pow(2.0, -i % 16);
        const Double3 other = best + to_double(random.point(-1, 1)) * reach;
        EXPECT_GE(star.cost(mesh, other), least * (1 - 1e-6));
    }
}

TEST(VertexMove, and_collapse_lower_the_cost_by_what_they_say)
{
    EditableMesh mesh(cubes().tets);
    Collapse collapse(mesh);
    VertexStar star;
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
        if (!mesh.is_free(v)) continue;
        const double before = mesh.cost();
        const bool moves = v % 2 == 0;
        const double gain = moves ? try_move(mesh, v, 0, star) : collapse.try_vertex(v, anything);
        EXPECT_NEAR(before - mesh.cost(), gain, 1e-10);
        EXPECT_EQ(mesh.is_free(v), moves || gain == 0);
    }
    expect_same_domain(mesh.take(), cubes());
}

TEST(Collapse, takes_the_neighbour_that_leaves_the_least_cost)
{
    const EditableMesh start(cubes().tets);
    std::array<int, 3> tried{}; // inside, on a side, on an edge of the box
    for (std::uint32_t v = 0; v < start.vertex_slots(); ++v) {
        if (!start.is_free(v) || ++tried[static_cast<std::size_t>(std::popcount(start.box_sides(v)))] > 8) continue;
        VertexStar star;
        EditableMesh first(cubes().tets);
        ASSERT_TRUE(find_star(first, v, 400, star));
        double best = impossible;
        std::set<std::uint32_t> neighbours;
        for (const std::uint32_t t : star.tets)
            neighbours.insert(start.tet(t).vertices.begin(), start.tet(t).vertices.end());
        neighbours.erase(v);
        for (const std::uint32_t onto : neighbours) {
            EditableMesh mesh(cubes().tets);
            std::vector<Corners> fresh;
            for (const std::uint32_t t : star.tets) {
                Corners corners = mesh.tet(t).vertices;
                if (std::find(corners.begin(), corners.end(), onto) != corners.end()) continue;
                std::replace(corners.begin(), corners.end(), v, onto);
                fresh.push_back(corners);
            }
            if (mesh.replace(star.tets, fresh)) best = std::min(best, mesh.cost());
        }
        const double gain = Collapse(first).try_vertex(v, anything);
        EXPECT_EQ(gain == 0, best == impossible);
        EXPECT_NEAR(first.cost(), gain == 0 ? start.cost() : best, 1e-12);
    }
}

TEST(Insertion, lowers_the_cost_by_what_it_says)
{
    EditableMesh mesh(cubes().tets);
    Insertion insertion(mesh);
    int inserted = 0;
    for (std::uint32_t i = 0; i < 6 * cubes().tets.tets.size(); i += 5) {
        const std::uint32_t t = i / 6;
        if (!mesh.is_reached(t)) continue;
        const double before = mesh.cost();
        const double gain = insertion.try_edge(t, i % 6, i % 2 == 0 ? 0 : anything);
        ASSERT_NEAR(before - mesh.cost(), gain, 1e-10);
        inserted += gain != 0 ? 1 : 0;
    }
    EXPECT_GT(inserted, 10);
    expect_same_domain(mesh.take(), cubes());
}

TEST(Insertion, is_tried_only_at_edges_whose_faces_are_large_enough)
{
    EditableMesh mesh(cubes().tets);
    Insertion insertion(mesh);
    EdgeRing ring;
    for (std::uint32_t edge = 0; edge < 6; ++edge) {
        if (!mesh.is_reached(0) || !find_ring(mesh, 0, edge, 24, from_any_tet, ring)) continue;
        double around = 0;
        for (const std::uint32_t v : ring.vertices)
            around += area(mesh.point(ring.a), mesh.point(ring.b), mesh.point(v));
        insertion.since = from_any_tet;
        insertion.min_ring_area = 1.001 * around;
        EXPECT_EQ(insertion.try_edge(0, edge, anything), 0);
        insertion.min_ring_area = 0.999 * around;
        if (insertion.try_edge(0, edge, anything) != 0) return;
    }
    FAIL() << "nothing was inserted";
}
