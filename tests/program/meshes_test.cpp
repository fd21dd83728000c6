// Surfaces that are not one closed, simple one: every structure's rays are right, by the oracle, and openmp's.
#include "tests/support/builder_meshes.h"
#include "tests/support/program_fixture.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The first line that begins so.
std::string line_of(const std::string& text, const std::string& begin)
{
    const std::size_t at = text.find("\n" + begin);
    return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

/// As tables write it.
std::string grouped(std::uint64_t number)
{
    return number < 1000 ? fmt::format("{}", number)
                         : fmt::format("{},{:03}", number / 1000, number % 1000); // enough for these meshes
}

class Meshes : public ProgramTest {
protected:
    void write(const std::string& name, const TriangleMesh& mesh) const { write_file(folder_ / name, to_off(mesh)); }

    /// The rows of check --out.
    [[nodiscard]] nlohmann::json rows() const { return nlohmann::json::parse(file("a.json"))["tetrace"]["rows"]; }

    /// The builds of build --out.
    [[nodiscard]] nlohmann::json builds() const { return nlohmann::json::parse(file("a.json"))["tetrace"]["builds"]; }

    /// Checks these scenes, with rays from outside and inside, primary ones and others.
    void expect_right(const std::string& scenes, const std::string& tets, std::size_t structures)
    {
        for (const std::string domain : {"tight", "wide --divisions 1 --camera-set flight --views 0,400"}) {
            const Ended ended =
                run(fmt::format("check --scene {} --tets {} --domain {} --size 32 --rays primary,diffuse,random "
                                "--structure cdt,bvh --method maria,project,single --backend openmp,embree "
                                "--schedule tiles,packets --out a.json",
                                scenes, tets, domain));
            ASSERT_EQ(ended.code, 0) << ended.errors << ended.out;
            std::set<std::string> seen;
            for (const auto& row : rows()) {
                if (row["status"] == "unsupported") continue; // packets on a processor that has none
                EXPECT_EQ(row["status"], "ok") << row["name"];
                EXPECT_GT(row["counts"][row["rays"] == "primary" ? "hits" : "rays"], 0) << row["name"];
                seen.insert(row["layout"]);
            }
            EXPECT_GE(seen.size(), structures);
        }
    }
};

} // namespace

TEST_F(Meshes, nested_open_and_separate_surfaces_are_traced_right_on_every_structure)
{
    write("nested.off", joined(box({-1, -1, -1}, {1, 1, 1}), moved(sphere(2), {0.1f, 0, 0}, 0.5f)));
    write("open.off", upper_half(sphere(3)));
    const TriangleMesh ball = sphere(1);
    write("apart.off", joined(joined(ball, moved(ball, {2.5f, 0.3f, 0})), moved(ball, {0.2f, 0.4f, 2.25f}, 0.25f)));
    write("one.off", {{{0, 0, 0}, {1, 0, 0.25f}, {0, 1, 0.5f}}, {{0, 1, 2}}});
    for (const char* const tets : {"rays", "cdt"})
        expect_right("nested.off,open.off,apart.off,one.off", tets, 7);
}

TEST_F(Meshes, far_from_the_origin_keep_their_shape_and_say_where_they_are)
{
    // An octahedron of 2 m in UTM coordinates, whose floats are half a metre apart.
    std::string text = "OFF\n6 8 0\n";
    for (const auto& [x, y, z] :
         std::vector<std::array<double, 3>>{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
        text += fmt::format("{} {} {}\n", 451234.25 + x, 5412345.75 + y, 320.5 + z);
    write_file(folder_ / "far,away.off",
               text + "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n");
    for (const std::string note :
         {"the centre of its bounding box, was subtracted", "was subtracted from its coordinates when"}) {
        const Ended ended = run("build --scene far,away.off --tets cdt --size 32 --out a.json");
        ASSERT_EQ(ended.code, 0) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, note));
        EXPECT_TRUE(contains(ended.out,
                             "far,away: cameras are placed in radii of 1.73205081 from its centre, (451234.25, "
                             "5412345.75, 320.5), in the mesh's coordinates."));
        const nlohmann::json scene = builds()[0]["scene_record"];
        const nlohmann::json centre = {451234.25, 5412345.75, 320.5};
        EXPECT_EQ(scene["centre"], centre);
        EXPECT_EQ(scene["subtracted"], centre);
        EXPECT_FALSE(scene.contains("rounding")) << "what is left are floats";
    }
}

TEST_F(Meshes, come_from_pipes)
{
    write("ball.off", sphere(1));
    const Ended ended = run("build --scene /dev/stdin --tets rays,cdt --size 32 --out a.json < ball.off");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(builds().size(), 2u) << "both of one reading";
    EXPECT_EQ(builds()[1]["scene_record"]["triangles"], 32);
    const Ended empty = run("build --scene /dev/stdin < /dev/null");
    EXPECT_EQ(empty.code, 2) << empty.errors;
}

TEST_F(Meshes, repaired_surfaces_are_traced_right_on_every_structure)
{
    write("cubes.off", joined(box({0, 0, 0}, {1, 1, 1}), box({0.5f, 0.25f, 0.375f}, {1.5f, 1.25f, 1.375f})));
    write("balls.off", joined(sphere(2), moved(sphere(2), {0.31f, 0.47f, 0.59f}, 0.9f)));
    write("flush.off", joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0.25f, 0.25f}, {2, 0.75f, 0.625f})));
    const Ended refused = run("check --scene cubes.off --no-repair --backend openmp --size 8");
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(contains(refused.errors, "a repair (without --no-repair) cuts them")) << refused.errors;
    for (const char* const tets : {"rays", "cdt"})
        expect_right("cubes.off,balls.off,flush.off", tets, 7);
    const auto scenes = nlohmann::json::parse(file("a.json"))["tetrace"]["scenes"];
    EXPECT_GT(scenes[0]["repair"]["cut_triangles"], 5);
    EXPECT_GT(scenes[2]["repair"]["dropped"], 0);
    for (const char* const verb : {"bench --samples 3 --tets cdt", "build --tets cdt", "render --out b.ppm --tets cdt",
                                   "reproduce table4 --builds ours"}) {
        const Ended ended = run(std::string(verb) + " --scene cubes.off --size 16 --views 0" +
                                (std::string(verb).starts_with("build") ? "" : " --backend openmp"));
        EXPECT_EQ(ended.code, 0) << verb << ended.errors;
    }
}

TEST_F(Meshes, results_name_the_file_s_triangles)
{
    // Two folded squares that cross; a piece's number would be another triangle's, or none's.
    const TriangleMesh mesh = {{{0, 0, 0},
                                {1, 0, 0},
                                {1, 1, 0.125f},
                                {0, 1, 0},
                                {0.25f, 0.25f, -0.5f},
                                {0.75f, 0.25f, -0.5f},
                                {0.5f, 0.75f, 0.5f},
                                {0.5f, 0.5f, 0.75f}},
                               {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    write("folds.off", mesh);
    std::set<std::size_t> seen;
    for (const char* const pixel : {"32,32", "28,26", "36,26", "30,20", "34,38"}) {
        const Ended ended = run(std::string("trace --scene folds.off --backend openmp --method maria --layout "
                                            "tet80 --size 64 --out a.json --pixel ") +
                                pixel);
        ASSERT_EQ(ended.code, 0) << ended.errors;
        const auto trace = nlohmann::json::parse(file("a.json"))["tetrace"]["trace"];
        const auto device = trace["devices"][0];
        const auto face = device["hit"]["face_id"].get<std::size_t>();
        ASSERT_LT(face, mesh.triangles.size());
        seen.insert(face);
        EXPECT_EQ(device["steps"].back()["beyond"], fmt::format("triangle {}", face));
        const auto [a, b, c] = mesh.triangles[face];
        const Double3 v0 = to_double(mesh.vertices[a]), edge_1 = to_double(mesh.vertices[b]) - v0,
                      edge_2 = to_double(mesh.vertices[c]) - v0;
        const auto vector = [&](const char* key) {
            return Double3{trace[key][0].get<double>(), trace[key][1].get<double>(), trace[key][2].get<double>()};
        };
        // The ray meets that triangle of the file, at the same t: the scene is as large as the file's mesh.
        const Double3 direction = vector("direction"), offset = vector("origin") - v0, p = cross(direction, edge_2),
                      q = cross(offset, edge_1);
        const double determinant = dot(edge_1, p), u = dot(offset, p) / determinant,
                     v = dot(direction, q) / determinant;
        EXPECT_NEAR(dot(edge_2, q) / determinant, device["hit"]["t"].get<double>(), 1e-5) << pixel;
        EXPECT_GT(std::min({u, v, 1 - u - v}), -1e-5) << pixel;
    }
    EXPECT_EQ(seen.size(), 2u);
}

TEST_F(Meshes, built_for_rays_are_listed_with_what_each_operation_brought)
{
    write("ball.off", sphere(2));
    const Ended ended = run("build --scene ball.off --tets cdt,rays --effort 3 --size 32 --out a.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto all = builds();
    ASSERT_EQ(all.size(), 2u);
    const auto &cdt = all[0], &rays = all[1], &made = rays["scene_record"]["optimised"];
    EXPECT_EQ(cdt["tets_kind"], "cdt");
    EXPECT_EQ(rays["tets_kind"], "rays");
    EXPECT_FALSE(cdt.contains("cost_before"));
    EXPECT_LT(rays["cost_after"], rays["cost_before"]);
    EXPECT_LT(rays["mean_steps"], cdt["mean_steps"]);
    EXPECT_TRUE(contains(ended.out, fmt::format("ball (tight, 8), the optimiser in {} rounds: cost {:.2f} before, "
                                                "{:.2f} after; steps per ray {:.2f} in the CDT, {:.2f} now\n",
                                                made["rounds"].get<int>(), rays["cost_before"].get<double>(),
                                                rays["cost_after"].get<double>(), cdt["mean_steps"].get<double>(),
                                                rays["mean_steps"].get<double>())))
        << ended.out;
    const double whole = rays["cost_before"].get<double>() - rays["cost_after"].get<double>();
    std::set<std::string> seen;
    double sum = 0;
    for (const auto& operation : made["operations"]) {
        const double gain = operation["gain"];
        sum += gain;
        const std::string name = operation["name"], share = fmt::format("{:.1f}", 100 * gain / whole);
        seen.insert(name);
        EXPECT_GT(operation["done"], 0) << name;
        const std::string line = line_of(ended.out, "  " + name + " ");
        for (const std::string& cell : {grouped(operation["done"]), fmt::format("{:.2f}", gain), share})
            EXPECT_TRUE(contains(line, " " + cell + " ")) << name;
    }
    EXPECT_EQ(seen, (std::set<std::string>{"edges removed", "faces removed", "moves", "collapses", "insertions"}));
    EXPECT_NEAR(sum, whole, 1e-9);
    for (const auto& build : all) { // the ball's inside is out of reach
        const auto& counts = build["scene_record"];
        const double share = counts["reached_tets"].get<double>() / counts["tets"].get<double>();
        EXPECT_LT(share, 1);
        EXPECT_NEAR(build["reached_mb"], build["size_mb"].get<double>() * share, 1e-12);
    }
}

TEST_F(Meshes, whose_tets_are_still_tetgens_are_listed_so_with_the_reason)
{
    write("ball.off", sphere(2));
    const Ended ended = run("build --scene ball.off --tets rays --optimise-time 1e-9 --size 16 --out a.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "ball: TetGen's tets are used: the optimiser was stopped before it had bettered "
                                       "any\n"));
    const auto made = builds()[0];
    EXPECT_EQ(made["tets_kind"], "cdt");
    EXPECT_EQ(made["cost_after"], made["cost_before"]);
    EXPECT_EQ(made["scene_record"]["optimised"]["reason"], "the optimiser was stopped before it had bettered any");
    EXPECT_FALSE(contains(ended.out, "the optimiser in ")) << "it has not listed operations";
}

TEST_F(Meshes, whose_triangles_cross_are_traced_through_bvhs_as_they_are)
{
    write_file(folder_ / "pair.off", to_off(crossing_pair()));
    for (const std::string verb : {"check", "bench --samples 3 --sample-time 0"}) {
        const Ended ended =
            run(verb + " --scene pair.off --no-repair --size 32 --layout half32,bvh2 --backend openmp --out a.json");
        EXPECT_EQ(ended.code, 2) << "of the rows without tets: " << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "1 pairs of triangles intersect")) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "its rows of structure bvh run without tets")) << ended.errors;
        for (const auto& row : rows())
            EXPECT_EQ(row["status"], row["structure"] == "cdt" ? "error" : "ok") << row["name"] << row["reason"];
    }
    const std::string check = "check --scene pair.off --size 32 --layout half32,bvh2 --backend openmp";
    for (const std::string repair : {"", " --repair"}) {
        EXPECT_EQ(run(check + repair + " --out a.json").code, 0);
        for (const auto& row : rows())
            EXPECT_EQ(row["status"], "ok") << row["name"] << row["reason"];
    }
    const Ended both = run(check + " --repair --no-repair");
    EXPECT_EQ(both.code, 2);
    EXPECT_TRUE(contains(both.errors, "--no-repair: --repair is given, too")) << both.errors;
    EXPECT_EQ(run("render --scene pair.off --no-repair --size 32 --views 0 --structure bvh --out a.ppm").code, 0);
}

TEST_F(Meshes, of_the_smallest_plant_have_tets)
{
    const Ended ended = run("check --scene plant@4000 --effort 0 --size 32 --views 0 --layout half32 --backend openmp");
    EXPECT_EQ(ended.code, 0) << ended.errors << "TetGen crashes with nearly all switches, in nearly all orders";
    EXPECT_TRUE(contains(ended.out, "Conforms")) << ended.out;
}

// The limit of time ends the builder before it has tets.
TEST_F(Meshes, whose_tets_cannot_be_built_are_traced_through_bvhs)
{
    for (const std::string domain : {"tight", "wide"}) {
        const Ended ended =
            run("check --scene banana --domain " + domain +
                " --time-limit 0.01 --size 32 --rays primary,shadow,ao,diffuse,random --structure cdt,bvh "
                "--layout half32,bvh2,cwbvh,embree --backend openmp,embree --out a.json");
        EXPECT_EQ(ended.code, 2) << "of the rows without tets: " << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "the limit of 0.01 s of processor time was reached")) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "its rows of structure bvh run without tets")) << ended.errors;
        std::size_t through_bvhs = 0, without_tets = 0;
        for (const auto& row : rows()) {
            if (row["structure"] == "cdt") {
                ++without_tets;
                EXPECT_EQ(row["status"],
                          row["schedule"] == "packets" && row["status"] == "unsupported" ? "unsupported" : "error");
                continue;
            }
            if (row["method"] == "stream" && row["status"] == "unsupported") continue; // Embree 4 has none
            ++through_bvhs;
            EXPECT_EQ(row["status"], "ok") << row["name"] << row["reason"];
            EXPECT_GT(row["counts"][row["rays"] == "primary" ? "hits" : "rays"], 0) << row["name"];
        }
        EXPECT_GE(through_bvhs, 15u) << "three layouts and five kinds of rays";
        EXPECT_GE(without_tets, 5u);
    }
    const Ended bench =
        run("bench --scene banana --time-limit 0.01 --size 32 --samples 3 --sample-time 0 --backend openmp "
            "--layout half32,bvh2 --out a.json");
    EXPECT_EQ(bench.code, 2) << bench.errors;
    EXPECT_TRUE(contains(bench.out, "banana: no tets, 25,000 triangles")) << bench.out;
    EXPECT_TRUE(contains(nlohmann::json::parse(file("a.json"))["tetrace"]["scenes"][0]["no_tets"].get<std::string>(),
                         "the limit of 0.01 s of processor time"));
    EXPECT_EQ(run("build --scene banana --time-limit 0.01").code, 2) << "nothing is built";
    const std::string render = "render --scene banana --time-limit 0.01 --size 32 --views 0 --out a.ppm";
    for (const std::string how : {"", " --structure bvh"})
        EXPECT_EQ(run(render + how).code, 0) << how;
    EXPECT_EQ(run(render + " --layout half32").code, 3) << "tets are asked for";
}

TEST_F(Meshes, of_tets_conform_in_each_task_and_are_written_again)
{
    write_file(folder_ / "own.mesh",
               "MeshVersionFormatted 2\nDimension 3\nVertices\n6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n-1 -1 "
               "0.5 0\nTetrahedra\n3\n1 2 3 4 7\n3 2 4 5 9\n1 3 4 6 7\nEnd\n");
    const std::string how = "--layout tet80,half32,tet64 --rays random --size 32 --views 0 --backend openmp";
    const Ended own = run("check --scene own.mesh --task segments,tally,trace " + how);
    EXPECT_EQ(own.code, 0) << own.errors << own.out;
    EXPECT_TRUE(contains(own.out, "Conforms")) << own.out;
    const Ended built = run("build --scene own.mesh --size 16 --out own.vtk");
    EXPECT_EQ(built.code, 0) << built.errors;
    EXPECT_TRUE(contains(file("own.vtk"), "SCALARS region long 1\nLOOKUP_TABLE default\n7\n9\n7\n0\n"));
    const Ended again = run("check --scene own.vtk --task segments " + how);
    EXPECT_EQ(again.code, 0) << again.errors << again.out;
    EXPECT_EQ(run("build --scene own.mesh,cubes --out two.vtk").code, 2);
    EXPECT_EQ(run("build --scene own.mesh --out no/such/folder/own.vtk").code, 2);
}
