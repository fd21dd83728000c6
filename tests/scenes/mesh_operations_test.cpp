// Operations of the optimiser against brute force, their reversal, and long random sequences of them.
#include "scenes/optimise/collapse.h"
#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/insertion.h"
#include "scenes/optimise/vertex_move.h"
#include "scenes/procedural.h"
#include "tests/scenes/edited_mesh.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/random.h"
#include "tests/support/sound_tets.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

// Links two tets where they share three vertices.
void link_tets(TetMesh& mesh)
{
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> open;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
        for (std::uint32_t face = 0; face < 4; ++face) {
            std::array<std::uint32_t, 3> key{};
            for (std::size_t i = 0; i < 3; ++i)
                key[i] = mesh.tets[t].vertices[face_corners[face][i]];
            std::sort(key.begin(), key.end());
            const auto [other, is_new] = open.try_emplace(key, make_half_face(t, face));
            if (is_new) continue;
            mesh.tets[t].neighbours[face] = other->second;
            mesh.tets[half_face_tet(other->second)].neighbours[half_face_index(other->second)] =
                make_half_face(t, face);
        }
}

TetMesh mesh_from(const std::vector<Float3>& points, const std::vector<Corners>& tets)
{
    TetMesh mesh{points, {}};
    for (const Corners& corners : tets)
        mesh.tets.push_back({corners,
                             {NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE},
                             {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    link_tets(mesh);
    return mesh;
}

// Two tets that share the face of vertices 0, 1, 2.
TetMesh two_tets(Random& random)
{
    std::vector<Float3> points;
    for (int i = 0; i < 3; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5 * random.unit()) / 3;
        points.push_back(snap_to_grid(to_float({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0})));
    }
    points.push_back(random.point(-0.5f, 0.5f));
    points.push_back(random.point(-0.5f, 0.5f));
    points[3].z = random.between(0.01f, 0.5f);
    points[4].z = random.between(-0.5f, -0.01f);
    for (Float3& point : points)
        point = snap_to_grid(point);
    return mesh_from(points, {{3, 0, 1, 2}, {4, 0, 2, 1}});
}

// All tets of these vertices that may be made.
std::vector<Corners> all_tets(const EditableMesh& mesh, std::span<const std::uint32_t> vertices)
{
    std::vector<Corners> all;
    const std::size_t n = vertices.size();
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b)
            for (std::size_t c = b + 1; c < n; ++c)
                for (std::size_t d = c + 1; d < n; ++d)
                    for (const bool turn : {false, true}) {
                        Corners corners = {vertices[a], vertices[b], vertices[c], vertices[d]};
                        if (turn) std::swap(corners[2], corners[3]);
                        if (may_be_made(mesh.point(corners[0]), mesh.point(corners[1]), mesh.point(corners[2]),
                                        mesh.point(corners[3])))
                            all.push_back(corners);
                    }
    return all;
}

// Least cost of the mesh with three tets of the same vertices in the place of two, all sets of three tried.
double cheapest_instead(const EditableMesh& start, const std::array<std::uint32_t, 2>& old)
{
    std::set<std::uint32_t> vertices;
    for (const std::uint32_t t : old)
        vertices.insert(start.tet(t).vertices.begin(), start.tet(t).vertices.end());
    const std::vector<Corners> tets = all_tets(start, std::vector<std::uint32_t>(vertices.begin(), vertices.end()));
    double best = impossible;
    for (std::uint32_t set = 1; set < 1u << tets.size(); ++set) {
        if (std::popcount(set) != 3) continue;
        std::vector<Corners> fresh;
        for (std::size_t i = 0; i < tets.size(); ++i)
            if ((set >> i & 1u) != 0) fresh.push_back(tets[i]);
        EditableMesh mesh = start;
        if (mesh.replace(old, fresh)) best = std::min(best, mesh.cost());
    }
    return best;
}

// Tries a face; what comes of it has to be the cheapest of all sets of tets, or nothing if there is none.
bool expect_cheapest(const EditableMesh& start, std::uint32_t tet, std::uint32_t face)
{
    const std::uint32_t half_face = start.tet(tet).neighbours[face];
    if (half_face == NO_HALF_FACE || !start.is_reached(tet) || start.tet(tet).faces[face] != FREE_FACE) return false;
    const double best = cheapest_instead(start, {tet, half_face_tet(half_face)});
    EditableMesh mesh = start;
    const double gain = try_face(mesh, tet, face, anything);
    EXPECT_EQ(gain == 0, best == impossible);
    EXPECT_NEAR(mesh.cost(), gain == 0 ? start.cost() : best, 1e-12);
    EXPECT_NEAR(start.cost() - mesh.cost(), gain, 1e-12);
    EditableMesh other = start;
    EXPECT_EQ(try_face(other, tet, face, 0) > 0, best < start.cost() - 1e-12);
    return gain != 0;
}

// n tets around the edge of vertices 0 and 1, and a tet more on each of their outer faces.
TetMesh ball(std::uint32_t n, double half_edge, Random& random)
{
    std::vector<Float3> points = {{0, 0, static_cast<float>(-half_edge)}, {0, 0, static_cast<float>(half_edge)}};
    const auto at = [&](double i, double radius, double z) {
        const double angle = 2 * std::numbers::pi * i / n;
        points.push_back(snap_to_grid(to_float({radius * std::cos(angle), radius * std::sin(angle), z})));
    };
    for (std::uint32_t i = 0; i < n; ++i)
        at(i, 0.3 + 0.4 * random.unit(), 0.2 * random.unit() - 0.1);
    std::vector<Corners> tets;
    for (std::uint32_t i = 0; i < n; ++i)
        tets.push_back({1, 0, 2 + i, 2 + (i + 1) % n});
    for (std::uint32_t i = 0; i < n; ++i)
        for (const std::uint32_t end : {0u, 1u}) {
            at(i + 0.5, 0.1 + 0.5 * random.unit(), (end == 0 ? -1 : 1) * (0.12 + 0.5 * random.unit()));
            const std::uint32_t p = 2 + i, q = 2 + (i + 1) % n, out = static_cast<std::uint32_t>(points.size()) - 1;
            tets.push_back(end == 0 ? Corners{out, 0, q, p} : Corners{1, out, q, p});
        }
    return mesh_from(points, tets);
}

// Least cost of a mesh with a vertex more: each set of tets that has those around its first edge is tried as its
// cavity.
double cheapest_cavity(const EditableMesh& start, Double3 at, std::uint32_t round_edge)
{
    double best = impossible;
    const std::uint32_t count = start.tet_slots(), ring = (1u << round_edge) - 1;
    for (std::uint32_t set = ring; set < 1u << count; ++set) {
        if ((set & ring) != ring) continue;
        EditableMesh mesh = start;
        const std::uint32_t vertex = mesh.add_vertex(at, 0);
        std::vector<std::uint32_t> old;
        std::vector<Corners> fresh;
        for (std::uint32_t t = 0; t < count; ++t) {
            if ((set >> t & 1u) == 0) continue;
            old.push_back(t);
            for (std::uint32_t face = 0; face < 4; ++face) {
                const std::uint32_t half_face = start.tet(t).neighbours[face];
                if (half_face != NO_HALF_FACE && (set >> half_face_tet(half_face) & 1u) != 0) continue;
                const auto& [i, j, k] = face_corners[face];
                const Corners& v = start.tet(t).vertices;
                fresh.push_back({vertex, v[i], v[j], v[k]});
            }
        }
        if (mesh.replace(old, fresh)) best = std::min(best, mesh.cost());
    }
    return best;
}

// Cubes of whose ball only the upper half is left: rays reach both sides of it.
Scene bowl()
{
    Scene scene = make_cubes(8);
    std::vector<std::uint32_t> place;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (const auto& triangle : scene.mesh.triangles) {
        const bool stays = std::all_of(triangle.begin(), triangle.end(),
                                       [&](std::uint32_t v) { return scene.mesh.vertices[v].z > -0.1f; });
        place.push_back(stays ? static_cast<std::uint32_t>(kept.size()) : FREE_FACE);
        if (stays) kept.push_back(triangle);
    }
    scene.mesh.triangles = kept;
    for (Tet& tet : scene.tets.tets)
        for (std::uint32_t& face : tet.faces)
            if (face != FREE_FACE) face = place[face];
    return scene;
}

struct Kind {
    const char* name;
    Scene scene;
};

enum RandomOperation { remove_edge, remove_face, move_vertex, collapse_vertex, insert_vertex, random_operations };

// Chooses operations and where to try them.
class RandomSequence {
public:
    RandomSequence(EditableMesh& mesh, std::uint64_t seed)
        : mesh_(mesh), edges_(mesh), collapse_(mesh), insertion_(mesh), random_(seed)
    {
    }

    /// Returns by how much cost fell.
    double attempt()
    {
        std::uint32_t t = random_.below(mesh_.tet_slots());
        for (int i = 0; i < 8 && !mesh_.is_reached(t); ++i)
            t = random_.below(mesh_.tet_slots());
        const std::uint32_t v = mesh_.tet(t).vertices[random_.below(4)];
        const bool is_reached = mesh_.is_reached(t), is_free = is_reached && mesh_.is_free(v);
        const double least = random_.below(2) == 0 ? anything : 0;
        double gain = 0;
        RandomOperation operation = random_operations;
        switch (random_.below(16)) {
        case 0:
        case 1:
            operation = insert_vertex;
            gain = is_reached ? insertion_.try_edge(t, random_.below(6), least) : 0;
            break;
        case 2:
            operation = collapse_vertex;
            gain = is_free ? collapse_.try_vertex(v, least) : 0;
            break;
        case 3:
        case 4:
        case 5:
            operation = move_vertex;
            gain = is_free ? try_move(mesh_, v, anything, star_) : 0;
            break;
        case 6:
        case 7:
        case 8:
        case 9:
            operation = remove_face;
            gain = is_reached ? try_face(mesh_, t, random_.below(4), anything) : 0;
            break;
        default:
            operation = remove_edge;
            gain = is_reached ? edges_.try_edge(t, random_.below(6), anything) : 0;
            break;
        }
        done[operation] += gain != 0 ? 1 : 0;
        return gain;
    }

    std::array<int, random_operations> done{};

private:
    EditableMesh& mesh_;
    EdgeRemoval edges_;
    Collapse collapse_;
    Insertion insertion_;
    VertexStar star_;
    Random random_;
};

} // namespace

TEST(FaceRemoval, makes_the_cheapest_other_tets_of_the_same_vertices)
{
    Random random(6);
    int removed = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const EditableMesh mesh(two_tets(random));
        for (std::uint32_t face = 0; face < 4; ++face)
            removed += expect_cheapest(mesh, 0, face) ? 1 : 0;
    }
    EXPECT_GT(removed, 100);
    EXPECT_LT(removed, 300) << "in some the edge would leave the two tets";
}

TEST(FaceRemoval, makes_the_cheapest_other_tets_in_a_mesh)
{
    const EditableMesh mesh(make_cubes(4).tets);
    int removed = 0;
    for (std::uint32_t i = 0; i < 4 * mesh.tet_slots(); i += 5)
        removed += expect_cheapest(mesh, i / 4, i % 4) ? 1 : 0;
    EXPECT_GT(removed, 20);
}

TEST(Insertion, finds_the_cavity_that_brute_force_finds)
{
    Random random(7);
    int inserted = 0, best = 0, grown = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const std::uint32_t n = 3 + static_cast<std::uint32_t>(trial) % 2;
        const TetMesh start = ball(n, 0.1, random);
        ASSERT_FALSE(find_defect(start, 0));
        EditableMesh mesh(start);
        const double before = mesh.cost(), gain = Insertion(mesh).try_edge(0, 0, anything);
        if (gain == 0) continue;
        ++inserted;
        const auto vertex = static_cast<std::uint32_t>(start.vertices.size());
        ASSERT_EQ(mesh.vertex_slots(), vertex + 1);
        EXPECT_FALSE(find_defect(mesh.take(), 0));
        EXPECT_NEAR(before - mesh.cost(), gain, 1e-12);
        const double brute = cheapest_cavity(EditableMesh(start), mesh.point(vertex), n);
        grown += mesh.take().tets.size() != 4 * n ? 1 : 0;
        EXPECT_GE(mesh.cost(), brute - 1e-12);
        best += mesh.cost() < brute + 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(inserted, 200);
    EXPECT_GT(best, 190) << "it grows by the best tet, so it need not find the best set of tets";
    EXPECT_GT(grown, 30) << "more than the tets around the edge";
}

TEST(Insertion, is_undone_by_collapse)
{
    Random random(8);
    int undone = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const TetMesh start = ball(3 + static_cast<std::uint32_t>(trial) % 4, 0.1, random);
        ASSERT_FALSE(find_defect(start, 0));
        EditableMesh mesh(start);
        const double cost = mesh.cost(), gain = Insertion(mesh).try_edge(0, 0, anything);
        if (gain == 0) continue;
        const double back = Collapse(mesh).try_vertex(static_cast<std::uint32_t>(start.vertices.size()), anything);
        if (corners_of(mesh) != corners_of(EditableMesh(start))) continue; // the cavity had grown
        ++undone;
        EXPECT_NEAR(back, -gain, 1e-12);
        EXPECT_NEAR(mesh.cost(), cost, 1e-12);
        EXPECT_EQ(mesh.take().vertices, start.vertices);
    }
    EXPECT_GT(undone, 80);
}

TEST(VertexMove, is_undone_by_a_move_back)
{
    const TetMesh start = make_cubes(8).tets;
    EditableMesh mesh(start);
    const double cost = mesh.cost();
    VertexStar star;
    std::array<int, 3> moved{}; // of vertices inside, on a side, on an edge of the box
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
        if (!mesh.is_free(v)) continue;
        const Double3 from = mesh.point(v);
        const double gain = try_move(mesh, v, anything, star);
        if (gain == 0) continue;
        ++moved[static_cast<std::size_t>(std::popcount(mesh.box_sides(v)))];
        EXPECT_GT(length(mesh.point(v) - from), 0);
        EXPECT_NEAR(cost - mesh.cost(), gain, 1e-10);
        ASSERT_TRUE(mesh.move(v, star.tets, from));
        ASSERT_EQ(mesh.cost(), cost);
    }
    EXPECT_EQ(mesh.take(), start);
    for (const int count : moved)
        EXPECT_GT(count, 20);
}

TEST(EditableMesh, stays_sound_through_many_random_operations)
{
    const std::array<Kind, 3> kinds = {
        {{"cubes", make_cubes(8)}, {"bowl", bowl()}, {"regular", std::move(make_hard_scenes().front().scene)}}};
    int attempts = 0;
    for (const auto& [name, scene] : kinds) {
        SCOPED_TRACE(name);
        EditableMesh mesh(scene.tets);
        RandomSequence sequence(mesh, 4);
        double cost = mesh.cost();
        for (int i = 0; i < 350'000; ++i, ++attempts) {
            cost -= sequence.attempt();
            if (i % 50'000 == 0) expect_same_domain(mesh.take(), scene);
        }
        EXPECT_NEAR(mesh.cost(), cost, 1e-8);
        expect_same_domain(mesh.take(), scene);
        for (const int done : sequence.done)
            EXPECT_GT(done, 3'000) << "of each operation";
        EXPECT_GT(std::accumulate(sequence.done.begin(), sequence.done.end(), 0), 40'000);
    }
    EXPECT_GE(attempts, 1'000'000);
}
