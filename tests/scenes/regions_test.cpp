// Regions: parts of a mesh that are changed apart from each other, and put together again.
#include "scenes/optimise/collapse.h"
#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/insertion.h"
#include "scenes/optimise/regions.h"
#include "scenes/optimise/vertex_move.h"
#include "scenes/procedural.h"
#include "tests/scenes/edited_mesh.h"
#include "tests/support/random.h"
#include "tests/support/sound_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<Region> all_regions(const MeshArrays& mesh, std::uint32_t pass, std::size_t max_tets)
{
    const Regions regions(mesh, pass, max_tets);
    std::vector<Region> parts;
    Regions::Scratch scratch;
    for (std::size_t i = 0; i < regions.size(); ++i)
        parts.push_back(regions.cut(i, 1, 7, scratch));
    return parts;
}

} // namespace

TEST(Regions, hold_each_tet_that_rays_reach_once)
{
    const MeshArrays mesh = arrays_of(cubes().tets);
    for (const std::size_t max_tets : {100, 700, 1'000'000}) {
        std::size_t tets = 0;
        std::set<Corners> all;
        for (const Region& region : all_regions(mesh, 0, max_tets)) {
            EXPECT_LE(region.mesh.tets.size(), max_tets);
            tets += region.mesh.tets.size();
            for (const Tet& tet : region.mesh.tets)
                all.insert({region.vertices[tet.vertices[0]], region.vertices[tet.vertices[1]],
                            region.vertices[tet.vertices[2]], region.vertices[tet.vertices[3]]});
        }
        EXPECT_EQ(tets, count_faces(cubes().tets).reached_tets);
        EXPECT_EQ(all.size(), tets);
    }
}

TEST(Regions, differ_from_one_pass_to_the_next)
{
    const MeshArrays mesh = arrays_of(cubes().tets);
    const std::vector<Region> first = all_regions(mesh, 0, 700), second = all_regions(mesh, 1, 700);
    EXPECT_NE(first.front().mesh.tets, second.front().mesh.tets);
    EXPECT_EQ(first.front().mesh.tets, all_regions(mesh, 0, 700).front().mesh.tets);
}

TEST(Regions, keep_what_lies_at_walls_and_ask_for_it_later)
{
    const MeshArrays mesh = arrays_of(cubes().tets);
    for (const Region& region : all_regions(mesh, 0, 700)) {
        std::set<std::uint32_t> at_walls, beside_parts; // an object's inside is not a part: its faces are never changed
        for (std::size_t t = 0; t < region.mesh.tets.size(); ++t)
            for (std::uint32_t face = 0; face < 4; ++face)
                if (region.mesh.tets[t].faces[face] != FREE_FACE &&
                    region.mesh.tets[t].faces[face] >= Region::first_wall) {
                    const Wall& wall = region.walls.at(region.mesh.tets[t].faces[face] - Region::first_wall);
                    const bool has_part_beyond = mesh.states[half_face_tet(wall.beyond)] == TetState::reached;
                    for (const std::uint32_t corner : face_corners[face]) {
                        at_walls.insert(region.mesh.tets[t].vertices[corner]);
                        if (has_part_beyond) beside_parts.insert(region.mesh.tets[t].vertices[corner]);
                    }
                }
        for (std::size_t t = 0; t < region.mesh.tets.size(); ++t) {
            const auto corners = std::ranges::count_if(region.mesh.tets[t].vertices,
                                                       [&](std::uint32_t v) { return beside_parts.contains(v); });
            EXPECT_EQ(region.mesh.tet_changed[t], corners > 1 ? 7u : 1u);
        }
        for (std::uint32_t v = 0; v < region.vertices.size(); ++v) {
            const bool is_free = mesh.kinds[region.vertices[v]] == VertexKind::free, at_wall = at_walls.contains(v);
            EXPECT_EQ(region.mesh.kinds[v], !is_free  ? VertexKind::held
                                            : at_wall ? VertexKind::at_wall
                                                      : VertexKind::free);
            EXPECT_EQ(region.mesh.vertex_changed[v], is_free && at_wall ? 7u : 1u);
        }
    }
}

TEST(Regions, give_back_the_mesh_that_they_were_cut_from)
{
    MeshArrays mesh = arrays_of(cubes().tets);
    const double cost = free_area(mesh);
    for (std::uint32_t pass = 0; pass < 3; ++pass)
        Regions::join(mesh, all_regions(mesh, pass, 300));
    EXPECT_NEAR(free_area(mesh), cost, 1e-9);
    EXPECT_EQ(mesh_of(mesh).vertices, cubes().tets.vertices);
    expect_same_domain(mesh_of(mesh), cubes());
}

TEST(Regions, stay_sound_through_random_operations_in_each)
{
    MeshArrays mesh = arrays_of(cubes().tets);
    double cost = free_area(mesh);
    Random random(5);
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random.bits() % n); };
    int done = 0;
    for (std::uint32_t pass = 0; pass < 12; ++pass) {
        std::vector<Region> parts = all_regions(mesh, pass, 400);
        for (Region& region : parts) {
            EditableMesh part(std::move(region.mesh));
            EdgeRemoval edges(part);
            Insertion insertion(part);
            Collapse collapse(part);
            VertexStar star;
            for (int i = 0; i < 1000; ++i) {
                const std::uint32_t t = below(part.tet_slots()), v = below(part.vertex_slots());
                double gain = 0;
                switch (part.is_reached(t) ? below(5) : 3) {
                case 0: gain = edges.try_edge(t, below(6), -1e9); break;
                case 1: gain = try_face(part, t, below(4), -1e9); break;
                case 2: gain = insertion.try_edge(t, below(6), below(64) == 0 ? -1e9 : 0); break;
                case 4: gain = part.is_free(v) ? collapse.try_vertex(v, -1e9) : 0; break;
                default: gain = part.is_free(v) ? try_move(part, v, -1e9, star) : 0; break;
                }
                done += gain != 0 ? 1 : 0;
                cost -= gain;
            }
            region.mesh = part.take_arrays();
        }
        Regions::join(mesh, std::move(parts));
        ASSERT_NEAR(free_area(mesh), cost, 1e-8);
        expect_same_domain(mesh_of(mesh), cubes());
    }
    EXPECT_GT(done, 1000);
}
