#include "core/error.h"
#include "core/exact.h"
#include "scenes/builder/build.h"
#include "scenes/builder/clean.h"
#include "scenes/builder/convert_tets.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/place.h"
#include "scenes/builder/run_tetgen.h"
#include "scenes/builder/self_intersection.h"
#include "scenes/builder/steiner_rounding.h"
#include "scenes/scene_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace tetrace {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_sanitized = true;
#elif defined(__has_feature)
constexpr bool address_sanitized = __has_feature(address_sanitizer);
#else
constexpr bool address_sanitized = false;
#endif

TriangleMesh tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// The surface of a box is a cube with large flat regions, each cut into 2 n n triangles.
TriangleMesh flat_cube(std::uint32_t n)
{
    std::vector<float> line;
    for (std::uint32_t i = 0; i <= n; i++)
        line.push_back(0.3f + 0.7f * static_cast<float>(i) / static_cast<float>(n));
    return domain_surface({DomainKind::tight, n, {line, line, line}});
}

TriangleMesh sphere(int subdivisions)
{
    TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int i = 0; i < subdivisions; i++) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, is_new] =
                middles.try_emplace(std::minmax({a, b}), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new)
                mesh.vertices.push_back(
                    to_float(normalized(to_double(mesh.vertices[a]) + to_double(mesh.vertices[b]))));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = finer;
    }
    return mesh;
}

// Two triangles that cross, far from any shared vertex.
TriangleMesh crossing_pair()
{
    return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, {{0, 1, 2}, {3, 4, 5}}};
}

std::string to_off(const TriangleMesh& mesh)
{
    std::ostringstream text;
    text.precision(9);
    text << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
    for (const Float3 v : mesh.vertices)
        text << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const auto& [a, b, c] : mesh.triangles)
        text << "3 " << a << ' ' << b << ' ' << c << '\n';
    return text.str();
}

class Builder : public testing::Test {
protected:
    Builder() : folder_(std::filesystem::temp_directory_path() / ("tetrace-builder-" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(folder_);
    }
    ~Builder() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    BuilderOptions options(const TriangleMesh& mesh, DomainKind domain, const std::string& switches) const
    {
        return {write("mesh.off", to_off(mesh)), folder_ / "out.tet", "", domain, 4, switches};
    }

    struct Ended {
        int code;
        std::string errors;
    };
    Ended run(const std::string& arguments, const std::string& before = "") const
    {
        const auto log = folder_ / "log";
        const std::string command =
            before + "'" TETRACE_BUILDER_PROGRAM "' " + arguments + " 2> '" + log.string() + "' > /dev/null";
        const int status = std::system(command.c_str());
        std::ifstream file(log);
        std::string errors{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, errors};
    }
    Ended run_on(const std::filesystem::path& mesh, const std::string& more = "", const std::string& before = "") const
    {
        return run("--mesh '" + mesh.string() + "' --out '" + (folder_ / "out.tet").string() + "' " + more, before);
    }

    std::filesystem::path folder_;
};

BuilderTalk silence()
{
    return {[](const std::string&) {}, [](const std::string&) {}};
}

bool is_boundary_corner(const Scene& scene, Float3 corner)
{
    return std::find(scene.tets.vertices.begin(), scene.tets.vertices.end(), corner) != scene.tets.vertices.end();
}

void expect_sound(const Scene& scene)
{
    const auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
    EXPECT_FALSE(defect) << defect->what;
    const auto gap = find_gap(scene.tets, scene.mesh, to_double(scene.domain.high()) - to_double(scene.domain.low()));
    EXPECT_FALSE(gap) << gap->what;
    EXPECT_NO_THROW(static_cast<void>(make_entry_grid(scene.domain, scene.tets)));
    for (const Float3 v : scene.tets.vertices)
        EXPECT_EQ(snap_to_grid(v), v);
    for (const Float3 corner : domain_surface(scene.domain).vertices)
        EXPECT_TRUE(is_boundary_corner(scene, corner));
    for (const Float3 vertex : scene.mesh.vertices)
        EXPECT_TRUE(is_boundary_corner(scene, vertex)) << "an input vertex moved";
}

// Every occlusive face has its corners on the triangle that it names: a swap of two coplanar triangles would keep all
// areas.
void expect_faces_inside_their_triangles(const Scene& scene)
{
    for (const Tet& tet : scene.tets.tets) {
        for (std::size_t face = 0; face < 4; face++) {
            if (tet.faces[face] == FREE_FACE) continue;
            const auto& [a, b, c] = scene.mesh.triangles[tet.faces[face]];
            const Double3 va = to_double(scene.mesh.vertices[a]), vb = to_double(scene.mesh.vertices[b]),
                          vc = to_double(scene.mesh.vertices[c]);
            Double3 centre;
            for (std::size_t i = 0; i < 4; i++)
                if (i != face) centre = centre + to_double(scene.tets.vertices[tet.vertices[i]]) * (1.0 / 3);
            const double whole = length(cross(vb - va, vc - va));
            const double parts = length(cross(va - centre, vb - centre)) + length(cross(vb - centre, vc - centre)) +
                                 length(cross(vc - centre, va - centre));
            ASSERT_NEAR(parts, whole, 1e-4 * whole) << "a face of triangle " << tet.faces[face] << " lies outside it";
        }
    }
}

Scene build(const BuilderOptions& options)
{
    PreparedScene prepared = prepare_scene(options, silence());
    const TetgenOutput output = run_tetgen(prepared.scene.mesh, prepared.surface, options.switches);
    return finish_scene(std::move(prepared), output, silence());
}

TEST(CleanUp, counts_what_it_takes_away)
{
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, -0.0f}, {2, 0, 0}, {9, 9, 9}, {0, 0, 1}},
                      {{0, 1, 2}, {2, 3, 1}, {0, 1, 4}, {0, 3, 1}, {1, 2, 6}}};
    const CleanUp cleaned = clean_up(mesh);
    EXPECT_EQ(cleaned, (CleanUp{1, 2, 2, 1}));
    EXPECT_EQ(mesh, (TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 2, 3}}}));
    EXPECT_EQ(clean_up(mesh), CleanUp{}) << "a clean mesh stays";
}

TEST(CleanUp, tells_thin_triangles_from_collinear_ones_exactly)
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
            for (std::size_t i = 0; i < mesh.vertices.size(); i++)
                for (int axis = 0; axis < 3; axis++)
                    ASSERT_EQ(std::ldexp(mesh.vertices[i][axis], -placement.scale_exponent), before.vertices[i][axis]);
            const Domain domain = make_domain(mesh, kind, 8);
            float reach = 0;
            for (int axis = 0; axis < 3; axis++)
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
    for (std::uint32_t i = 0; i < 8; i++) {
        mesh.triangles.push_back({3, 4, static_cast<std::uint32_t>(mesh.vertices.size())});
        mesh.vertices.push_back({2, 1 + 0.1f * static_cast<float>(i + 1), 1});
    }
    const auto found = find_self_intersections(mesh, 3);
    EXPECT_EQ(found.count, 9u);
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    EXPECT_EQ(found.first, (std::vector<Pair>{{0, 1}, {0, 2}, {0, 3}}));
    const std::string text = describe(found, mesh, 1);
    EXPECT_NE(text.find("triangle 1 (0.5, 0.5, -0.5) (0.5, 0.5, 0.5) (1, 0.5, 0.5)"), std::string::npos) << text;
    EXPECT_NE(text.find("does not repair"), std::string::npos) << text;
}

// A tet cut into four at a point that rounding pushed just through one of its faces.
TetMesh four_tets(Float3 middle)
{
    TetMesh mesh{{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, middle}, {}};
    for (std::size_t i = 0; i < 4; i++) {
        Tet tet{{1, 0, 2, 3}, {NO_LINK, NO_LINK, NO_LINK, NO_LINK}, {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}};
        tet.vertices[i] = 4;
        mesh.tets.push_back(tet);
    }
    return mesh;
}

TEST(SteinerRounding, mends_inverted_and_flat_tets_by_a_near_float)
{
    for (const float depth : {0.0f, -0x1p-24f, -0x1p-20f}) {
        TetMesh mesh = four_tets({0.125f, 0.125f, depth});
        std::vector<Freedom> freedom(5);
        freedom[4] = {{true, true, true}, 1 << 12};
        const auto [before, after, moved] = mend_tets(mesh, freedom);
        EXPECT_EQ(before, 1u);
        EXPECT_EQ(after, 0u);
        EXPECT_EQ(moved, 1u);
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
    EXPECT_EQ(mend_tets(mesh, freedom)[1], 1u);
    freedom[4] = {{true, true, false}, 1 << 12};
    EXPECT_EQ(mend_tets(mesh, freedom)[1], 1u);
    EXPECT_EQ(mesh, before);
}

TEST_F(Builder, fills_both_domains_round_every_kind_of_mesh)
{
    const std::vector<TriangleMesh> meshes = {tetrahedron(), flat_cube(6), sphere(3)};
    for (std::size_t i = 0; i < meshes.size(); i++) {
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
    EXPECT_NE(scene.build.tool.find("TetGen 1."), std::string::npos) << scene.build.tool;
    EXPECT_GT(scene.build.build_s, 0);
    EXPECT_EQ(scene.domain.kind, DomainKind::wide);
}

class AbsurdOutput : public Builder {
protected:
    AbsurdOutput() : options_(options(sphere(1), DomainKind::wide, "pq")), prepared_(prepare_scene(options_, silence()))
    {
        output_ = run_tetgen(prepared_.scene.mesh, prepared_.surface, options_.switches);
    }
    void expect_absurd(const std::string& part)
    {
        try {
            static_cast<void>(finish_scene(prepared_, output_, silence()));
            ADD_FAILURE() << "damaged output passed";
        } catch (const BuilderFailure& failure) {
            EXPECT_EQ(failure.code(), BUILDER_ABSURD_OUTPUT);
            EXPECT_NE(std::string(failure.what()).find(part), std::string::npos) << failure.what();
            EXPECT_NE(std::string(failure.what()).find(try_other_switches), std::string::npos) << failure.what();
        }
    }

    BuilderOptions options_;
    PreparedScene prepared_;
    TetgenOutput output_;
};

TEST_F(AbsurdOutput, names_missing_tets)
{
    output_.tets.clear();
    output_.neighbours.clear();
    expect_absurd("no tets");
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

TEST_F(AbsurdOutput, names_a_boundary_beside_the_domain_s_sides)
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
    ASSERT_GT(output_.points.size(), output_.input_points);
    const Double3 apex = output_.points.back(); // a Steiner point
    output_.points.back() = {-apex.x, -apex.y, -apex.z};
    expect_absurd("0 were so in TetGen's double coordinates already");
}

TEST_F(Builder, writes_a_scene_that_can_be_read_back)
{
    const auto ended =
        run_on(write("ball.off", to_off(sphere(2))), "--name ball --domain wide --divisions 2 --switches pq5");
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_NE(ended.errors.find("stage: TetGen pq5\n"), std::string::npos) << ended.errors;
    const Scene scene = read_scene(folder_ / "out.tet");
    EXPECT_EQ(scene.name, "ball");
    EXPECT_EQ(scene.domain.kind, DomainKind::wide);
    EXPECT_EQ(scene.domain.divisions, 2u);
    expect_sound(scene);
}

TEST_F(Builder, notes_what_it_dropped)
{
    TriangleMesh mesh = tetrahedron();
    mesh.triangles.push_back({1, 2, 0});
    mesh.triangles.push_back({1, 1, 0});
    const auto ended = run_on(write("a.off", to_off(mesh)));
    EXPECT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_NE(ended.errors.find("note: 1 triangles without area dropped\n"), std::string::npos) << ended.errors;
    EXPECT_NE(ended.errors.find("note: 1 duplicate triangles dropped\n"), std::string::npos) << ended.errors;
    EXPECT_EQ(read_scene(folder_ / "out.tet").build.duplicate_triangles, 1u);
}

TEST_F(Builder, answers_help_and_version)
{
    EXPECT_EQ(run("--help").code, BUILDER_GOOD);
    EXPECT_EQ(run("--version").code, BUILDER_GOOD);
}

TEST_F(Builder, refuses_wrong_options_with_code_2)
{
    const auto mesh = write("a.off", to_off(tetrahedron()));
    EXPECT_EQ(run("").code, BUILDER_USAGE);
    for (const std::string wrong :
         {"--domian tight", "--domain square", "--divisions 0", "--divisions 65", "--divisions two", "--switches q5",
          "--switches pr", "--switches pq5Yo2", "extra"}) {
        const auto ended = run_on(mesh, wrong);
        EXPECT_EQ(ended.code, BUILDER_USAGE) << wrong;
        EXPECT_EQ(ended.errors.rfind("error: ", 0), 0u) << wrong << ": " << ended.errors;
    }
}

TEST_F(Builder, refuses_bad_meshes_with_code_5)
{
    const auto ended = run_on(write("a.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_EQ(ended.code, BUILDER_BAD_MESH);
    EXPECT_NE(ended.errors.find("a.off: vertex 1 (line 4)"), std::string::npos) << ended.errors;
    EXPECT_EQ(run_on(write("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")).code, BUILDER_BAD_MESH) << "no area";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.tet"));
}

TEST_F(Builder, tells_missing_files_with_code_3)
{
    EXPECT_EQ(run_on(folder_ / "none.off").code, BUILDER_MISSING_FILE);
    const auto mesh = write("a.off", to_off(tetrahedron()));
    EXPECT_EQ(run("--mesh '" + mesh.string() + "' --out '" + (folder_ / "none" / "out.tet").string() + "'").code,
              BUILDER_MISSING_FILE);
}

TEST_F(Builder, lists_self_intersections_with_code_10)
{
    const auto ended = run_on(write("a.off", to_off(crossing_pair())));
    EXPECT_EQ(ended.code, BUILDER_SELF_INTERSECTION);
    EXPECT_NE(ended.errors.find("error:   triangle 1 (1, 1, -1) (1, 1, 1) (2, 1, 1)\n"), std::string::npos)
        << ended.errors;
}

TEST_F(Builder, tells_tetgens_refusal_with_code_11)
{
    // Two triangles over one edge, so close to each other that TetGen takes them for one.
    const TriangleMesh hinge{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}, {0.5f, 1, 1e-9f}}, {{0, 1, 2}, {0, 1, 3}}};
    const auto ended = run_on(write("a.off", to_off(hinge)));
    EXPECT_EQ(ended.code, BUILDER_TETGEN_REFUSED) << ended.errors;
    EXPECT_NE(ended.errors.find("error: TetGen gave up with code 3"), std::string::npos) << ended.errors;
    EXPECT_NE(ended.errors.find(try_other_switches), std::string::npos) << ended.errors;
}

TEST_F(Builder, tells_exhausted_memory_with_code_13)
{
    if (address_sanitized) GTEST_SKIP() << "AddressSanitizer reserves more address space than any limit";
    const auto mesh = write("a.off", to_off(tetrahedron()));
    std::filesystem::resize_file(mesh, 400u << 20); // a hole: it takes no room on disk
    const auto ended = run_on(mesh, "", "ulimit -v 200000; ");
    EXPECT_EQ(ended.code, BUILDER_OUT_OF_MEMORY) << ended.errors;
    EXPECT_NE(ended.errors.find("out of memory"), std::string::npos) << ended.errors;
    EXPECT_NE(ended.errors.find(allow_more_memory), std::string::npos) << ended.errors;
}

} // namespace
} // namespace tetrace
