// What the builder makes of TetGen's tets: a sound scene of every kind of mesh, mended where rounding inverts a tet,
// and refused where the output is absurd.
#include "core/base/exact.h"
#include "scenes/builder/cavity_fill.h"
#include "scenes/builder/convert_tets.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/run_cgal.h"
#include "scenes/builder/run_tetgen.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/sound_tets.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

using namespace tetrace;
using namespace tetrace::test;

namespace {

BuilderTalk silence()
{
    return {[](const std::string&) {}, [](const std::string&) {}};
}

// Every occlusive face has its corners on the triangle that it names: a swap of two coplanar triangles would keep all
// areas.
void expect_faces_inside_their_triangles(const Scene& scene)
{
    for (const Tet& tet : scene.tets.tets) {
        for (std::size_t face = 0; face < 4; ++face) {
            if (tet.faces[face] == FREE_FACE) continue;
            const auto& [a, b, c] = scene.mesh.triangles[tet.faces[face]];
            const Double3 va = to_double(scene.mesh.vertices[a]), vb = to_double(scene.mesh.vertices[b]),
                          vc = to_double(scene.mesh.vertices[c]);
            Double3 centre;
            for (std::size_t i = 0; i < 4; ++i)
                if (i != face) centre = centre + to_double(scene.tets.vertices[tet.vertices[i]]) * (1.0 / 3);
            const double whole = length(cross(vb - va, vc - va));
            const double parts = length(cross(va - centre, vb - centre)) + length(cross(vb - centre, vc - centre)) +
                                 length(cross(vc - centre, va - centre));
            ASSERT_NEAR(parts, whole, 1e-4 * whole) << "a face of triangle " << tet.faces[face] << " is outside it";
        }
    }
}

Scene build(const BuilderOptions& options, const BuilderTalk& talk = silence())
{
    PreparedScene prepared = prepare_scene(options, talk);
    const RawTets output = run_tetgen(prepared.scene.mesh, prepared.surface, prepared.points, options.switches);
    return finish_scene(std::move(prepared), output, talk);
}

// A tet cut into four at a point that rounding pushed just through one of its faces.
TetMesh four_tets(Float3 middle)
{
    TetMesh mesh{{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, middle}, {}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        Tet tet{{1, 0, 2, 3}, {}, {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}};
        tet.vertices[i] = 4;
        for (std::uint32_t k = 0; k < 4; ++k) // the one across corner k has the middle there
            tet.neighbours[k] = k == i ? NO_HALF_FACE : make_half_face(k, i);
        mesh.tets.push_back(tet);
    }
    return mesh;
}

/// An open sheet of 8 x 8 squares; up: the height of every other vertex.
TriangleMesh grid(float up)
{
    TriangleMesh sheet;
    for (std::uint32_t i = 0; i < 81; ++i)
        sheet.vertices.push_back({static_cast<float>(i % 9) / 8, static_cast<float>(i / 9) / 8, i % 2 == 0 ? 0 : up});
    for (std::uint32_t i = 0; i < 72; ++i) {
        if (i % 9 == 8) continue;
        sheet.triangles.push_back({i, i + 1, i + 10});
        sheet.triangles.push_back({i, i + 10, i + 9});
    }
    return sheet;
}

/// The first mesh, and the second one times a factor, then moved by as much along each axis.
TriangleMesh joined(TriangleMesh first, const TriangleMesh& second, float factor, float offset)
{
    const auto base = static_cast<std::uint32_t>(first.vertices.size());
    for (const Float3 v : second.vertices)
        first.vertices.push_back({factor * v.x + offset, factor * v.y + offset, factor * v.z + offset});
    for (const auto& [a, b, c] : second.triangles)
        first.triangles.push_back({base + a, base + b, base + c});
    return first;
}

/// Builds meshes for rays in both domains.
class OptimisingBuilder : public Builder {
protected:
    [[nodiscard]] Scene expect_optimised(const TriangleMesh& mesh, DomainKind domain, const std::string& switches) const
    {
        BuilderOptions asked = options(mesh, domain, switches);
        asked.tets = TetsKind::rays;
        asked.divisions = 8;
        Scene scene = build(asked);
        expect_sound(scene);
        expect_faces_inside_their_triangles(scene);
        const OptimisedInfo& made = scene.build.optimised;
        EXPECT_EQ(made.asked, TetsKind::rays);
        EXPECT_EQ(made.end, OptimiserEnd::finished);
        EXPECT_EQ(made.tets, TetsKind::rays); // each of these meshes can be bettered, so a refusal is a defect
        EXPECT_EQ(made.reason, "");
        EXPECT_LT(made.cost_after, made.cost_before);
        return scene;
    }
};

class AbsurdOutput : public Builder {
protected:
    AbsurdOutput() : options_(options(sphere(1), DomainKind::wide, "pq")), prepared_(prepare_scene(options_, silence()))
    {
        output_ = run_tetgen(prepared_.scene.mesh, prepared_.surface, prepared_.points, options_.switches);
    }
    void expect_absurd(const std::string& part)
    {
        try {
            static_cast<void>(finish_scene(prepared_, output_, silence()));
            ADD_FAILURE() << "damaged output passed";
        } catch (const BuilderFailure& failure) {
            EXPECT_EQ(failure.code(), BUILDER_ABSURD_OUTPUT);
            EXPECT_TRUE(contains(failure.what(), part));
            EXPECT_TRUE(contains(failure.what(), std::string(try_other_switches)));
        }
    }

    BuilderOptions options_;
    PreparedScene prepared_;
    RawTets output_;
};

} // namespace

TEST_F(Builder, cgal_makes_tets_of_the_same_surface_where_it_can_and_says_that_it_cannot_elsewhere)
{
    const BuilderOptions asked = options(joined(sphere(1), sphere(1), 0.25f, 0.3f), DomainKind::tight, "cgal");
    PreparedScene prepared = prepare_scene(asked, silence());
    prepared.points = {{0.45f, 0.45f, 0.45f}};
    const Scene before = prepared.scene;
    RawTets output;
    try {
        output = run_cgal(before.mesh, prepared.surface, prepared.points);
    } catch (const BuilderFailure& failure) {
        EXPECT_EQ(failure.code(), BUILDER_TETGEN_REFUSED);
        EXPECT_TRUE(contains(failure.what(), "makes no tets, 6.1 and later do")) << failure.what();
        GTEST_SKIP() << failure.what();
    }
    EXPECT_EQ(output.input_points, before.mesh.vertices.size() + prepared.surface.vertices.size());
    const Scene scene = finish_scene(std::move(prepared), output, silence());
    expect_sound(scene);
    expect_faces_inside_their_triangles(scene);
    EXPECT_EQ(scene.mesh.triangles, before.mesh.triangles);
    EXPECT_EQ(scene.build.switches, cgal_switches);
    output.neighbours[0][0] = output.neighbours[0][0] < 1 ? 1 : 0;
    try {
        static_cast<void>(finish_scene(prepare_scene(asked, silence()), output, silence()));
        ADD_FAILURE() << "damaged output passed";
    } catch (const BuilderFailure& failure) {
        EXPECT_TRUE(contains(failure.what(), "checking CGAL's output")) << failure.what();
    }
}

TEST(SteinerRounding, mends_inverted_and_flat_tets_by_a_near_float)
{
    for (const float depth : {0.0f, -0x1p-24f, -0x1p-20f}) {
        TetMesh mesh = four_tets({0.125f, 0.125f, depth});
        std::vector<Freedom> freedom(5);
        freedom[4] = {{true, true, true}, 1 << 12};
        EXPECT_EQ(mend_tets(mesh, freedom), (Rounding{.damaged = 1, .repaired = 1, .moved_points = 1}));
        EXPECT_NEAR(mesh.vertices[4].z, 0, 0x1p-18);
        for (const Tet& tet : mesh.tets)
            EXPECT_LT(orientation(mesh.vertices[tet.vertices[0]], mesh.vertices[tet.vertices[1]],
                                  mesh.vertices[tet.vertices[2]], mesh.vertices[tet.vertices[3]]),
                      0);
    }
}

TEST(SteinerRounding, leaves_what_may_not_move)
{
    TetMesh mesh = four_tets({0.125f, 0.125f, -0x1p-20f});
    const TetMesh before = mesh;
    std::vector<Freedom> freedom(5);
    EXPECT_EQ(mend_tets(mesh, freedom), Rounding{.damaged = 1});
    freedom[4] = {{true, true, false}, 1 << 12};
    EXPECT_EQ(mend_tets(mesh, freedom), Rounding{.damaged = 1});
    EXPECT_EQ(mesh, before);
}

TEST(SteinerRounding, puts_other_tets_in_place_where_no_point_may_move)
{
    // Three tets around an edge that passes outside the triangle across it, where two fit.
    TetMesh mesh{{{0, 0, 0.25f}, {0.5f, 0, 0.25f}, {0, 0.5f, 0.25f}, {0.375f, 0.375f, 0.5f}, {0.375f, 0.375f, 0}}, {}};
    for (std::uint32_t i = 0; i < 3; ++i)
        mesh.tets.push_back(
            {{3, 4, i, (i + 1) % 3},
             {NO_HALF_FACE, NO_HALF_FACE, make_half_face((i + 1) % 3, 3), make_half_face((i + 2) % 3, 2)},
             {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    const std::vector<Freedom> none(5);
    EXPECT_EQ(mend_tets(mesh, none), (Rounding{.damaged = 1, .repaired = 1, .refilled = 1}));
    EXPECT_EQ(mesh.tets.size(), 2u);
    EXPECT_FALSE(find_defect(mesh, 0));
}

TEST(SteinerRounding, removes_points_though_moves_took_all_their_tests)
{
    constexpr std::uint32_t count = 50;
    const TetMesh one = four_tets({0.125f, 0.125f, -0.25f}); // too far off for a move
    TetMesh mesh;
    std::vector<Freedom> freedom(5 * count);
    for (std::uint32_t i = 0; i < count; ++i) {
        mesh.vertices.insert(mesh.vertices.end(), one.vertices.begin(), one.vertices.end());
        freedom[5 * i + 4] = {{true, true, true}, 1 << 12};
        for (Tet tet : one.tets) {
            for (std::uint32_t k = 0; k < 4; ++k) {
                tet.vertices[k] += 5 * i;
                if (tet.neighbours[k] != NO_HALF_FACE) tet.neighbours[k] += make_half_face(4 * i, 0);
            }
            mesh.tets.push_back(tet);
        }
    }
    TetMesh same = mesh;
    EXPECT_EQ(mend_tets(mesh, freedom, 10'000),
              (Rounding{.damaged = count, .repaired = count, .removed_points = count}));
    EXPECT_EQ(mesh.tets.size(), count);
    EXPECT_LT(mend_tets(same, freedom, 1'000).removed_points, count) << "removals have an end, too";
}

namespace {

/// Of each vertex, the triangles that faces at it are parts of; and whether it may move: Steiner points off the
/// domain's sides.
struct Vertices {
    std::vector<std::set<std::uint32_t>> triangles;
    std::vector<Freedom> freedom;
};

Vertices vertices_of(const Scene& scene)
{
    const std::size_t inputs = scene.mesh.vertices.size() + domain_surface(scene.domain).vertices.size();
    Vertices result{std::vector<std::set<std::uint32_t>>(scene.tets.vertices.size()),
                    std::vector<Freedom>(scene.tets.vertices.size())};
    for (std::size_t i = inputs; i < result.freedom.size(); ++i)
        result.freedom[i] = {{true, true, true}, 1};
    for (const Tet& tet : scene.tets.tets)
        for (std::uint32_t face = 0; face < 4; ++face)
            for (const std::uint32_t corner : face_corners[face]) {
                if (tet.faces[face] != FREE_FACE) result.triangles[tet.vertices[corner]].insert(tet.faces[face]);
                if (tet.neighbours[face] == NO_HALF_FACE) result.freedom[tet.vertices[corner]] = {};
            }
    return result;
}

/// A neighbour that is on the same triangles; the vertex itself if it has none.
std::uint32_t neighbour_of(const TetMesh& mesh, const Vertices& vertices, std::uint32_t vertex)
{
    for (const Tet& tet : mesh.tets)
        if (std::ranges::find(tet.vertices, vertex) != tet.vertices.end())
            for (const std::uint32_t other : tet.vertices)
                if (other != vertex && std::ranges::includes(vertices.triangles[other], vertices.triangles[vertex]))
                    return other;
    return vertex;
}

} // namespace

TEST_F(Builder, mends_tets_that_a_steiner_point_far_off_its_place_inverts)
{
    const Scene scene = build(options(flat_cube(1), DomainKind::wide, "pq1.6a0.0002"));
    const Vertices vertices = vertices_of(scene);
    constexpr std::size_t enough = 7;
    std::array<std::size_t, 3> tried{}, mended{}; // inside, in a triangle, on an edge
    std::uint64_t removed = 0;
    for (std::uint32_t vertex = 0; vertex < vertices.freedom.size(); ++vertex) {
        const std::size_t kind = std::min<std::size_t>(vertices.triangles[vertex].size(), 2);
        if (vertices.freedom[vertex].steps == 0 || tried[kind] == enough) continue;
        const std::uint32_t other = neighbour_of(scene.tets, vertices, vertex);
        if (other == vertex) continue;
        ++tried[kind];
        TetMesh mesh = scene.tets;
        const Double3 from = to_double(mesh.vertices[vertex]), to = to_double(mesh.vertices[other]);
        mesh.vertices[vertex] = snap_to_grid(to_float(from + (to - from) * 1.25));
        const Rounding done = mend_tets(mesh, vertices.freedom);
        EXPECT_GT(done.damaged, 0u);
        removed += done.removed_points;
        if (done.repaired < done.damaged) continue;
        ++mended[kind];
        EXPECT_FALSE(find_defect(mesh, scene.mesh.triangles.size()));
        EXPECT_FALSE(find_gap(mesh, scene.mesh, to_double(scene.domain.high()) - to_double(scene.domain.low())));
        Scene after = scene;
        after.tets = mesh;
        expect_faces_inside_their_triangles(after);
    }
    EXPECT_GT(removed, 0u);
    for (std::size_t kind = 0; kind < 3; ++kind) {
        EXPECT_GE(tried[kind], 5u) << kind;
        EXPECT_GE(4 * mended[kind], 3 * tried[kind]) << kind;
    }
}

TEST(CavityFill, finds_tets_where_there_are_some)
{
    // Schoenhardt's: a prism whose lid is turned, so that its sides bend inwards and no tet of its corners is inside.
    std::vector<Float3> points;
    for (int i = 0; i < 6; ++i) {
        const double angle = 2 * M_PI * (i % 3) / 3 + (i < 3 ? 0 : M_PI / 6);
        points.push_back(to_float({0.5 * std::cos(angle), 0.5 * std::sin(angle), i < 3 ? 0.0 : 0.5}));
    }
    points.push_back({0, 0, 0.25f});
    const auto fill = [&](bool bent, bool with_middle, std::uint64_t tests = 10'000) {
        std::set<FaceSide> front{{0, 1, 2}, {3, 5, 4}};
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = i, b = (i + 1) % 3, c = 3 + a, d = 3 + b;
            for (const std::array<std::uint32_t, 4>& tet :
                 {std::array{6u, a, c, bent ? d : b}, {6u, bent ? a : c, d, b}})
                front.insert(face_side_of(tet, 0));
        }
        std::set<std::uint32_t> vertices{0, 1, 2, 3, 4, 5};
        if (with_middle) vertices.insert(6);
        CavityFill cavity(points, front, vertices, 1000, tests);
        const bool found = cavity.find(with_middle ? std::set<std::uint32_t>{6} : std::set<std::uint32_t>{});
        double volume = 0;
        for (const auto& [a, b, c, d] : cavity.tets()) {
            const Double3 o = to_double(points[a]);
            EXPECT_LT(orientation(points[a], points[b], points[c], points[d]), 0);
            volume -= dot(to_double(points[b]) - o, cross(to_double(points[c]) - o, to_double(points[d]) - o)) / 6;
        }
        return std::pair(found, volume);
    };
    const double inwards = 0.108253, outwards = 0.202003;
    EXPECT_EQ(fill(true, false), std::pair(false, 0.0));
    EXPECT_TRUE(fill(true, true).first);
    EXPECT_NEAR(fill(true, true).second, inwards, 1e-6);
    for (const bool with_middle : {false, true}) {
        EXPECT_TRUE(fill(false, with_middle).first);
        EXPECT_NEAR(fill(false, with_middle).second, outwards, 1e-6);
    }
    EXPECT_FALSE(fill(false, true, 20).first) << "no tests are left";
}

TEST_F(Builder, fills_both_domains_round_every_kind_of_mesh)
{
    const std::vector<TriangleMesh> meshes = {tetrahedron(), flat_cube(6), sphere(3)};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        for (const DomainKind domain : {DomainKind::tight, DomainKind::wide}) {
            for (const std::string switches : {"p", "pq5Y", "pq5", "pq5YM", "pq"}) {
                SCOPED_TRACE("mesh " + std::to_string(i) + ", domain " + std::to_string(static_cast<int>(domain)) +
                             ", switches " + switches);
                const Scene scene = build(options(meshes[i], domain, switches));
                expect_sound(scene);
                expect_faces_inside_their_triangles(scene);
                EXPECT_EQ(scene.mesh.triangles.size(), meshes[i].triangles.size());
            }
        }
    }
}

TEST_F(OptimisingBuilder, betters_every_kind_of_mesh)
{
    const TriangleMesh single{{{0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0.1f}}, {{0, 1, 2}}};
    const TriangleMesh sliver{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-4f, 0}, {0.5f, 0.2f, 0.7f}}, {{0, 1, 2}, {0, 1, 3}}};
    for (const TriangleMesh& mesh : {tetrahedron(), flat_cube(6), sphere(3), single, sliver, grid(0)})
        for (const DomainKind domain : {DomainKind::tight, DomainKind::wide})
            for (const std::string switches : {"pY", "pq5Y"}) {
                SCOPED_TRACE(std::to_string(mesh.triangles.size()) + " triangles, " + std::string(name_of(domain)) +
                             ", " + switches);
                const Scene plain = build(options(mesh, domain, switches));
                const Scene scene = expect_optimised(mesh, domain, switches);
                EXPECT_EQ(scene.mesh, plain.mesh);
                if (switches == "pq5Y") { // no points were added: the surfaces are those of the plain build
                    EXPECT_EQ(fixed_faces(scene.tets), fixed_faces(plain.tets));
                }
            }
}

TEST_F(OptimisingBuilder, betters_hostile_meshes)
{
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "takes five minutes here; the optimiser's other tests do not";
#endif
    TriangleMesh needles; // around one axis
    for (std::uint32_t i = 0; i < 12; ++i) {
        const auto angle = static_cast<float>(i) * 0.5f, radius = 1e-3f;
        needles.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
        needles.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 1});
        if (i > 0) needles.triangles.push_back({2 * i - 2, 2 * i, 2 * i - 1});
    }
    TriangleMesh repaired = sphere(1);
    repaired.triangles.push_back(repaired.triangles.front());
    repaired.triangles.push_back({1, 1, 2});
    const std::pair<const char*, TriangleMesh> meshes[] = {
        {"nearly flat", grid(1e-6f)},
        {"closed in closed", joined(sphere(1), sphere(1), 0.5f, 0)},
        {"cubes that share a corner", joined(flat_cube(1), flat_cube(1), -1, 2)},
        {"needles", needles},
        {"repaired", repaired}};
    for (const auto& [name, mesh] : meshes)
        for (const DomainKind domain : {DomainKind::tight, DomainKind::wide}) {
            SCOPED_TRACE(std::string(name) + ", " + std::string(name_of(domain)));
            static_cast<void>(expect_optimised(mesh, domain, "pY"));
        }
}

TEST_F(OptimisingBuilder, inserts_vertices_for_several_pieces_and_begins_with_more_on_the_sides)
{
    const TriangleMesh pair = joined(sphere(2), sphere(2), 0.5f, 3);
    for (const auto& [mesh, pieces] : {std::pair{sphere(2), 1U}, std::pair{pair, 2U}}) {
        EXPECT_EQ(count_pieces(mesh), pieces);
        BuilderOptions asked = options(mesh, DomainKind::tight, "pY");
        asked.tets = TetsKind::rays;
        const PreparedScene prepared = prepare_scene(asked, silence());
        EXPECT_EQ(prepared.surface.triangles.size(),
                  pieces * pieces * domain_surface(prepared.scene.domain).triangles.size());
        EXPECT_FALSE(prepared.points.empty());
        asked.repair = true;
        asked.weld = 0x1p-20;
        const PreparedScene welded = prepare_scene(asked, silence());
        EXPECT_TRUE(welded.points.empty()) << "TetGen has failed before";
        EXPECT_EQ(welded.surface.triangles.size(), domain_surface(welded.scene.domain).triangles.size());
        const Scene scene = expect_optimised(mesh, DomainKind::tight, "pY");
        EXPECT_EQ(scene.build.optimised.operations.back().done > 0, pieces > 1);
        EXPECT_EQ(scene.domain.divisions, 8U) << "that rays look up";
    }
}

TEST_F(Builder, keeps_tetgens_tets_where_the_optimised_ones_fail_a_check)
{
    const Scene scene = build(options(sphere(2), DomainKind::tight, "pq5Y"));
    const OptimisedTets good = optimise(scene.tets, {1, 0}, {});
    EXPECT_EQ(objection_to(good, scene), "");
    const auto objection_after = [&](const auto& damage) {
        OptimisedTets bad = good;
        damage(bad);
        return objection_to(bad, scene);
    };
    EXPECT_TRUE(contains(objection_after([](auto& bad) { bad.report.cost_after = bad.report.cost_before; }),
                         "found nothing to better"));
    EXPECT_TRUE(contains(objection_after([](auto& bad) {
                             std::swap(bad.mesh.tets[7].vertices[0], bad.mesh.tets[7].vertices[1]);
                             std::swap(bad.mesh.tets[7].neighbours[0], bad.mesh.tets[7].neighbours[1]);
                         }),
                         "fail a check"));
    EXPECT_TRUE(contains(objection_after([](auto& bad) { bad.mesh.tets.pop_back(); }), "fail a check"));
    EXPECT_TRUE(contains(objection_after([](auto& bad) {
                             for (Tet& tet : bad.mesh.tets)
                                 for (std::uint32_t& face : tet.faces)
                                     if (face == 3) face = FREE_FACE;
                         }),
                         "missing input triangles"));
}

TEST_F(Builder, keeps_tetgens_tets_where_it_was_stopped_before_it_bettered_any_and_says_so)
{
    BuilderOptions asked = options(sphere(2), DomainKind::tight, "pq5Y");
    const Scene plain = build(asked);
    asked.tets = TetsKind::rays;
    asked.optimise_for_s = 1e-9;
    std::string notes;
    const Scene scene = build(asked, {[](const std::string&) {}, [&](const std::string& note) { notes += note; }});
    EXPECT_EQ(scene.tets, plain.tets);
    const OptimisedInfo& made = scene.build.optimised;
    EXPECT_EQ(made.tets, TetsKind::cdt);
    EXPECT_EQ(made.end, OptimiserEnd::out_of_time);
    EXPECT_EQ(made.reason, "the optimiser was stopped before it had bettered any");
    EXPECT_EQ(made.cost_after, made.cost_before);
    EXPECT_TRUE(made.operations.empty());
    EXPECT_EQ(notes, "TetGen's tets are used: " + made.reason);
}

TEST_F(Builder, leaves_tetgens_tets_with_effort_0)
{
    for (const std::string switches : {"pq5Y", "pY"}) { // with pY, points are only for the optimiser
        BuilderOptions asked = options(sphere(2), DomainKind::tight, switches);
        const Scene plain = build(asked);
        asked.tets = TetsKind::rays;
        asked.effort = 0;
        const Scene scene = build(asked);
        EXPECT_EQ(scene.tets, plain.tets);
        EXPECT_EQ(scene.build.optimised.tets, TetsKind::cdt);
        EXPECT_EQ(scene.build.optimised.reason, "--effort is 0");
    }
}

TEST_F(Builder, keeps_triangles_and_squares_whole_with_y)
{
    const Scene scene = build(options(flat_cube(6), DomainKind::tight, "pq5Y"));
    const TetMeshCounts counts = count_faces(scene.tets);
    EXPECT_EQ(counts.occlusive_faces, 12u * 6 * 6);
    EXPECT_EQ(counts.boundary_faces, 12u * 4 * 4);
}

TEST_F(Builder, records_how_the_scene_came_to_be)
{
    const Scene scene = build(options(sphere(1), DomainKind::wide, "pq5Y"));
    EXPECT_EQ(scene.name, "mesh");
    EXPECT_EQ(scene.build.source, "mesh.off");
    EXPECT_NE(scene.build.source_hash, 0u);
    EXPECT_EQ(scene.build.switches, "pq5Y");
    EXPECT_TRUE(contains(scene.build.tool, "TetGen 1."));
    EXPECT_GT(scene.build.build_s, 0);
    EXPECT_EQ(scene.domain.kind, DomainKind::wide);
}

TEST_F(AbsurdOutput, names_missing_tets)
{
    output_.tets.clear();
    output_.neighbours.clear();
    expect_absurd("without tets");
}

TEST_F(AbsurdOutput, names_indices_out_of_range)
{
    output_.tets[5][2] = static_cast<std::int32_t>(output_.points.size());
    expect_absurd("tet 5 names a vertex");
}

TEST_F(AbsurdOutput, names_asymmetric_neighbours)
{
    std::swap(output_.neighbours[7][0], output_.neighbours[7][1]);
    expect_absurd("asymmetric neighbours");
}

// Two pairs of neighbours change partners: each names the other back, over faces that have other vertices.
TEST_F(AbsurdOutput, names_neighbours_that_share_other_vertices)
{
    const auto exchange = [&](std::size_t tet, std::int32_t from, std::int32_t to) {
        auto& row = output_.neighbours[tet];
        const auto at = std::find(row.begin(), row.end(), from);
        ASSERT_NE(at, row.end());
        *at = to;
    };
    const auto inner = [&](std::int32_t tet) {
        const auto& row = output_.neighbours[static_cast<std::size_t>(tet)];
        return *std::find_if(row.begin(), row.end(), [](std::int32_t n) { return n >= 0; });
    };
    const std::int32_t a = 0, c = static_cast<std::int32_t>(output_.tets.size()) - 1;
    const std::int32_t b = inner(a), d = inner(c);
    ASSERT_TRUE(b != c && b != d && a != d);
    exchange(static_cast<std::size_t>(a), b, d);
    exchange(static_cast<std::size_t>(d), c, a);
    exchange(static_cast<std::size_t>(c), d, b);
    exchange(static_cast<std::size_t>(b), a, c);
    expect_absurd("which does not name it back");
}

TEST_F(AbsurdOutput, names_a_domain_that_is_not_filled)
{
    const std::size_t hole = output_.tets.size() - 1;
    for (const auto& face : output_.surface_faces) // a tet of free faces, so that only the volume tells
        for (const std::int32_t corner : face.corners) {
            const auto& tet = output_.tets[hole];
            ASSERT_TRUE(face.triangle < 0 || std::find(tet.begin(), tet.end(), corner) == tet.end());
        }
    output_.tets.pop_back();
    output_.neighbours.pop_back();
    for (auto& row : output_.neighbours)
        std::replace(row.begin(), row.end(), static_cast<std::int32_t>(hole), -1);
    expect_absurd("volume of the domain: the tets' volumes sum to");
}

TEST_F(AbsurdOutput, names_a_boundary_off_the_domain_s_sides)
{
    for (float& line : prepared_.scene.domain.lines[0])
        line += 0.0625f; // as large, so that the volume does not tell
    expect_absurd("the domain's sides: making the entry grid: tet");
}

TEST_F(AbsurdOutput, names_missing_triangles)
{
    std::erase_if(output_.surface_faces, [](const auto& face) { return face.triangle == 3; });
    expect_absurd("missing input triangles");
}

TEST_F(AbsurdOutput, names_faces_of_another_triangle)
{
    for (auto& face : output_.surface_faces)
        if (face.triangle == 3) face.triangle = 4;
    expect_absurd("missing input triangles");
}

TEST_F(AbsurdOutput, names_surface_faces_that_no_tet_has)
{
    output_.surface_faces.push_back({{0, 1, 1}, 0}); // without area, so that the sum of areas does not tell
    expect_absurd("faces lie on input triangles");
}

TEST_F(AbsurdOutput, names_inverted_tets_and_who_made_them)
{
    Double3& point = output_.points[output_.input_points - 1]; // on the domain's sides, so that nothing may mend it
    point = {-point.x, -point.y, -point.z};
    expect_absurd("0 were so in TetGen's double coordinates already");
}
