// Operations on the sides of the domain: boundary faces become others that cover the same region of the same side, and
// vertices stay on the sides that they lie on.
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

const Scene& coarse_cubes()
{
    static const Scene scene = make_cubes(6);
    return scene;
}

/// n - 1 tets around the edge from (0, 0, -1/2) to (0, 0, 1/2), which is on the side y = 0: half of a fan.
TetMesh half_fan(std::uint32_t n, Random& random)
{
    TetMesh mesh{{{0, 0, -0.5f}, {0, 0, 0.5f}}, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = std::numbers::pi * i / (n - 1), radius = 0.3 + 0.4 * random.unit();
        const double y = i == 0 || i == n - 1 ? 0 : radius * std::sin(angle);
        mesh.vertices.push_back(snap_to_grid(to_float({radius * std::cos(angle), y, 0.2 * random.unit() - 0.1})));
    }
    for (std::uint32_t i = 0; i + 1 < n; ++i)
        mesh.tets.push_back({{1, 0, 2 + i, 3 + i},
                             {NO_HALF_FACE, NO_HALF_FACE, i + 2 < n ? make_half_face(i + 1, 3) : NO_HALF_FACE,
                              i > 0 ? make_half_face(i - 1, 2) : NO_HALF_FACE},
                             {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    return mesh;
}

double side_area(const TetMesh& mesh)
{
    double sum = 0;
    for (const Tet& tet : mesh.tets)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const auto at = [&](std::size_t i) {
                return to_double(mesh.vertices[tet.vertices[face_corners[face][i]]]);
            };
            if (tet.neighbours[face] == NO_HALF_FACE && at(0).y == 0 && at(1).y == 0 && at(2).y == 0)
                sum += area(at(0), at(1), at(2));
        }
    return sum;
}

/// The first free vertex on that many sides of the box.
std::uint32_t vertex_on(const EditableMesh& mesh, int sides)
{
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v)
        if (mesh.is_free(v) && std::popcount(mesh.box_sides(v)) == sides) return v;
    return NO_TET;
}

std::vector<Corners> put_onto(const EditableMesh& mesh, const VertexStar& star, std::uint32_t v, std::uint32_t onto)
{
    std::vector<Corners> fresh;
    for (const std::uint32_t t : star.tets) {
        Corners corners = mesh.tet(t).vertices;
        if (std::find(corners.begin(), corners.end(), onto) != corners.end()) continue;
        std::replace(corners.begin(), corners.end(), v, onto);
        fresh.push_back(corners);
    }
    return fresh;
}

} // namespace

TEST(BoxSides, refuses_boundary_faces_that_do_not_cover_what_the_old_ones_did)
{
    for (const int sides : {1, 2}) {
        EditableMesh mesh(coarse_cubes().tets);
        const std::uint32_t v = vertex_on(mesh, sides);
        VertexStar star;
        ASSERT_TRUE(find_star(mesh, v, 400, star));
        std::set<std::uint32_t> neighbours;
        for (const std::uint32_t t : star.tets)
            neighbours.insert(mesh.tet(t).vertices.begin(), mesh.tet(t).vertices.end());
        int refused = 0;
        for (const std::uint32_t onto : neighbours) {
            if ((mesh.box_sides(v) & ~mesh.box_sides(onto)) == 0) continue;
            EXPECT_FALSE(mesh.replace(star.tets, put_onto(mesh, star, v, onto))) << "a dent in the box";
            ++refused;
        }
        EXPECT_GT(refused, 0);
        for (const std::uint32_t t : star.tets) {
            const std::array<std::uint32_t, 1> one = {t};
            EXPECT_FALSE(mesh.replace(one, {})) << "a tet less";
        }
        EXPECT_EQ(mesh.take(), coarse_cubes().tets);
    }
}

TEST(BoxSides, refuses_what_touches_all_sides_of_the_box)
{
    Scene box = make_cubes(2); // its ball is one cube at a corner
    for (Tet& tet : box.tets.tets)
        tet.faces.fill(FREE_FACE);
    EditableMesh mesh(box.tets);
    std::vector<std::uint32_t> all(mesh.tet_slots());
    for (std::uint32_t t = 0; t < mesh.tet_slots(); ++t)
        all[t] = t;
    EXPECT_FALSE(mesh.replace(all, {})) << "nothing is left of the box";
    EXPECT_EQ(mesh.take(), box.tets);
}

TEST(BoxSides, edge_removal_finds_the_cheapest_of_all_triangulations_of_an_open_ring)
{
    Random random(5);
    int removed = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const std::uint32_t n = 3 + static_cast<std::uint32_t>(trial) % 6;
        const TetMesh start = half_fan(n, random);
        for (const std::uint32_t from : {0u, n - 2}) { // the ring is found from each of its tets
            EditableMesh mesh(start);
            EdgeRing ring;
            ASSERT_TRUE(find_ring(mesh, from, 0, max_around_edge, from_any_tet, ring));
            ASSERT_TRUE(ring.is_open());
            ASSERT_EQ(ring.tets.size(), n - 1);
            ASSERT_EQ(ring.vertices.size(), n);
            if (from != 0) continue;
            const double before = mesh.cost(), expected = cheapest(mesh, ring, 0, n - 1);
            const double gain = EdgeRemoval(mesh).try_edge(0, 0, anything);
            if (expected == impossible) {
                EXPECT_EQ(mesh.take(), start);
                continue;
            }
            ++removed;
            EXPECT_NEAR(mesh.cost(), expected, 1e-12);
            EXPECT_NEAR(before - mesh.cost(), gain, 1e-12);
            EXPECT_EQ(mesh.take().tets.size(), 2 * (n - 2));
            EXPECT_NEAR(side_area(mesh.take()), side_area(start), 1e-9);
            EXPECT_FALSE(find_defect(mesh.take(), 0));
        }
    }
    EXPECT_GT(removed, 100);
}

TEST(BoxSides, edge_removal_with_two_tets_is_its_own_inverse)
{
    Random random(6);
    const TetMesh start = half_fan(3, random);
    EditableMesh mesh(start);
    EdgeRemoval edges(mesh);
    const double gain = edges.try_edge(0, 0, anything);
    ASSERT_EQ(mesh.take().tets.size(), 2u);
    double back = 0;
    for (std::uint32_t edge = 0; edge < 6 && back == 0; ++edge)
        back = edges.try_edge(0, edge, anything);
    EXPECT_NEAR(back, -gain, 1e-12);
    EXPECT_NEAR(mesh.cost(), EditableMesh(start).cost(), 1e-12);
}

TEST(BoxSides, vertices_slide_to_where_no_other_point_of_their_sides_is_cheaper)
{
    for (const int sides : {1, 2}) {
        EditableMesh mesh(coarse_cubes().tets);
        const std::uint32_t v = vertex_on(mesh, sides);
        const BoxSides held = mesh.box_sides(v);
        VertexStar star;
        ASSERT_TRUE(find_star(mesh, v, 400, star));
        const Double3 from = mesh.point(v), best = cheapest_point(mesh, star.edges, held, from, 500);
        const double least = star.cost(mesh, best);
        Random random(7);
        for (int i = 0; i < 1000; ++i) {
            const Double3 way = to_double(random.point(-1, 1)) * std::pow(2.0, -i % 16);
            const Double3 other = best + Double3{holds_axis(held, 0) ? 0 : way.x, holds_axis(held, 1) ? 0 : way.y,
                                                 holds_axis(held, 2) ? 0 : way.z};
            EXPECT_GE(star.cost(mesh, other), least * (1 - 1e-6));
        }
        EXPECT_TRUE(!holds_axis(held, 0) || best.x == from.x);
        EXPECT_TRUE(!holds_axis(held, 1) || best.y == from.y);
        EXPECT_TRUE(!holds_axis(held, 2) || best.z == from.z);
    }
}

TEST(BoxSides, a_vertex_cannot_leave_its_side)
{
    EditableMesh mesh(coarse_cubes().tets);
    const std::uint32_t v = vertex_on(mesh, 1);
    VertexStar star;
    ASSERT_TRUE(find_star(mesh, v, 400, star));
    for (const double way : {0x1p-10, -0x1p-10}) {
        const Double3 inwards{holds_axis(mesh.box_sides(v), 0) ? way : 0, holds_axis(mesh.box_sides(v), 1) ? way : 0,
                              holds_axis(mesh.box_sides(v), 2) ? way : 0};
        EXPECT_FALSE(mesh.move(v, star.tets, mesh.point(v) + inwards));
    }
    EXPECT_EQ(mesh.take(), coarse_cubes().tets);
}

TEST(BoxSides, operations_on_them_lower_the_cost_by_what_they_say)
{
    EditableMesh mesh(coarse_cubes().tets);
    Collapse collapse(mesh);
    EdgeRemoval edges(mesh);
    Insertion insertion(mesh);
    VertexStar star;
    Random random(8);
    std::array<int, 4> done{};
    for (int i = 0; i < 20'000; ++i) {
        const std::uint32_t v = random.below(mesh.vertex_slots()), kind = random.below(4);
        if (mesh.tet_of(v) == NO_TET || mesh.box_sides(v) == 0) continue;
        const std::uint32_t t = mesh.tet_of(v);
        if (!mesh.is_reached(t)) continue;
        const double before = mesh.cost();
        double gain = 0;
        if (kind < 2 && !mesh.is_free(v)) continue;
        switch (kind) {
        case 0: gain = collapse.try_vertex(v, anything); break;
        case 1: gain = try_move(mesh, v, 0, star); break;
        case 2: gain = edges.try_edge(t, random.below(6), anything); break;
        default: gain = insertion.try_edge(t, random.below(6), random.below(4) == 0 ? anything : 0); break;
        }
        ASSERT_NEAR(before - mesh.cost(), gain, 1e-10);
        done[kind] += gain != 0 ? 1 : 0;
        if (i % 4000 == 0) expect_same_domain(mesh.take(), coarse_cubes());
    }
    for (const int count : done)
        EXPECT_GT(count, 20);
    expect_same_domain(mesh.take(), coarse_cubes());
}
