// The program tetrace-builder: what it writes, what it says, and the code that it ends with.
#include "scenes/builder/failure.h"
#include "scenes/scene_file.h"
#include "tests/support/builder_meshes.h"

#include <cstdlib>
#include <fmt/format.h>
#include <sys/wait.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_sanitized = true;
#elif defined(__has_feature)
constexpr bool address_sanitized = __has_feature(address_sanitizer);
#else
constexpr bool address_sanitized = false;
#endif

class BuilderProgram : public Builder {
protected:
    struct Ended {
        int code;
        std::string errors;
    };
    [[nodiscard]] Ended run(const std::string& arguments, const std::string& before = "") const
    {
        const auto log = folder_ / "log";
        const std::string command =
            before + "'" TETRACE_BUILDER_PROGRAM "' " + arguments + " 2> '" + log.string() + "' > /dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(log)};
    }
    [[nodiscard]] Ended run_on(const std::filesystem::path& mesh, const std::string& more = "",
                               const std::string& before = "") const
    {
        return run("--mesh '" + mesh.string() + "' --out '" + (folder_ / "out.tet").string() + "' " + more, before);
    }
};

} // namespace

TEST_F(BuilderProgram, writes_a_scene_that_can_be_read_back)
{
    const auto ended =
        run_on(write("ball.off", to_off(sphere(2))), "--name ball --domain wide --divisions 2 --switches pq5");
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "stage: TetGen pq5\n"));
    const Scene scene = read_scene(folder_ / "out.tet");
    EXPECT_EQ(scene.name, "ball");
    EXPECT_EQ(scene.domain.kind, DomainKind::wide);
    EXPECT_EQ(scene.domain.divisions, 2u);
    expect_sound(scene);
}

TEST_F(BuilderProgram, optimises_tets_for_rays_and_says_so)
{
    const auto mesh = write("ball.off", to_off(sphere(3)));
    const auto ended = run_on(mesh, "--divisions 3 --switches pY --tets rays --effort 1 --optimise-for 60");
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "stage: optimising\nprogress: 0."));
    EXPECT_TRUE(contains(ended.errors, " round 1: a line crosses "));
    EXPECT_TRUE(contains(ended.errors, "note: optimised in "));
    const Scene scene = read_scene(folder_ / "out.tet");
    EXPECT_EQ(scene.build.optimised.tets, TetsKind::rays);
    EXPECT_EQ(scene.build.optimised.effort, 1);
    EXPECT_LT(scene.build.optimised.cost_after, scene.build.optimised.cost_before);
    double gain = 0;
    for (const OptimiserOperation& operation : scene.build.optimised.operations)
        gain += operation.gain;
    EXPECT_NEAR(gain, scene.build.optimised.cost_before - scene.build.optimised.cost_after, 1e-9);
    expect_sound(scene);
    EXPECT_EQ(run_on(mesh, "--tets delaunay").code, BUILDER_USAGE);
    EXPECT_EQ(run_on(mesh, "--effort 4").code, BUILDER_USAGE);
}

// Such switches are tried where TetGen failed, and it optimises its tets after all if it has points to insert.
TEST_F(BuilderProgram, gives_tetgen_no_more_points_where_its_optimiser_is_off)
{
    const auto mesh = write("ball.off", to_off(sphere(3)));
    const auto vertices_with = [&](const std::string& more) {
        const auto ended = run_on(mesh, "--tets rays --optimise-for 1e-9 --switches " + more);
        EXPECT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
        const Scene scene = read_scene(folder_ / "out.tet");
        expect_sound(scene);
        return scene.tets.vertices.size();
    };
    EXPECT_EQ(vertices_with("pYO0 --effort 2"), vertices_with("pYO0 --effort 0"));
    EXPECT_GT(vertices_with("pY --effort 2"), vertices_with("pY --effort 0"));
}

TEST_F(BuilderProgram, finishes_with_what_the_optimiser_has_reached_when_it_is_interrupted)
{
    const auto log = folder_ / "log";
    const std::string command =
        "'" TETRACE_BUILDER_PROGRAM "' --mesh '" + write("ball.off", to_off(sphere(6))).string() + "' --out '" +
        (folder_ / "out.tet").string() + "' --divisions 3 --switches pY --tets rays --effort 3 2> '" + log.string() +
        "' & pid=$!;" + " until grep -q '^progress: 0.0[1-9]' '" + log.string() +
        "' || ! kill -0 $pid; do sleep 0.02; done; kill -INT $pid; wait $pid";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_text(log);
    const Scene scene = read_scene(folder_ / "out.tet");
    EXPECT_EQ(scene.build.optimised.end, OptimiserEnd::interrupted);
    EXPECT_LT(scene.build.optimised.cost_after, scene.build.optimised.cost_before);
    expect_sound(scene);
}

TEST_F(BuilderProgram, says_when_the_optimiser_ran_out_of_time)
{
    const auto ended = run_on(write("ball.off", to_off(sphere(5))), "--switches pY --tets rays --optimise-for 0.05");
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    const Scene scene = read_scene(folder_ / "out.tet");
    EXPECT_EQ(scene.build.optimised.end, OptimiserEnd::out_of_time);
    expect_sound(scene);
}

TEST_F(BuilderProgram, notes_what_it_dropped)
{
    TriangleMesh mesh = tetrahedron();
    mesh.triangles.push_back({1, 2, 0});
    mesh.triangles.push_back({1, 1, 0});
    const auto ended = run_on(write("a.off", to_off(mesh)));
    EXPECT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "note: 1 triangles without area dropped\n"));
    EXPECT_TRUE(contains(ended.errors, "note: 1 duplicate triangles dropped\n"));
    EXPECT_EQ(read_scene(folder_ / "out.tet").build.duplicate_triangles, 1u);
}

TEST_F(BuilderProgram, subtracts_the_centre_of_a_mesh_far_from_the_origin_and_keeps_it)
{
    TriangleMesh ball = sphere(2);
    std::string text = fmt::format("OFF\n{} {} 0\n", ball.vertices.size(), ball.triangles.size());
    for (const Float3 v : ball.vertices) // UTM coordinates in metres, of an object of 2 m
        text += fmt::format("{:.6f} {:.6f} {:.6f}\n", 451234.1 + static_cast<double>(v.x),
                            5412345.9 + static_cast<double>(v.y), 320.7 + static_cast<double>(v.z));
    for (const auto& [a, b, c] : ball.triangles)
        text += fmt::format("3 {} {} {}\n", a, b, c);
    const auto ended = run_on(write("survey.off", text));
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_TRUE(
        contains(ended.errors, "note: the coordinates are large for the mesh's size: (451234.1, 5412345.9, 320.7"));
    const Scene scene = read_scene(folder_ / "out.tet");
    expect_sound(scene);
    EXPECT_NEAR(length(scene.build.centre - Double3{451234.1, 5412345.9, 320.7}), 0, 1e-6);
    EXPECT_GT(scene.build.rounding, 0);
    EXPECT_LT(scene.build.rounding, 1e-6);
    const BoundingSphere found = source_sphere(scene);
    EXPECT_NEAR(length(found.centre - Double3{451234.1, 5412345.9, 320.7}), 0, 1e-5);
    EXPECT_NEAR(found.radius, bounding_sphere(ball).radius, 1e-5);
}

TEST_F(BuilderProgram, says_how_far_rounding_moved_vertices_when_it_merged_some)
{
    const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", near = "0 0 0\n1.00000000001 0 0\n0 1 0\n0 0 1\n",
                      again = "1 0 0\n";
    EXPECT_FALSE(contains(run_on(write("a.off", "OFF\n4 4 0\n" + near + faces), "--mesh-only").errors, "rounding"));
    const std::string text = "OFF\n5 5 0\n" + near + again + faces + "3 0 4 2\n";
    const auto ended = run_on(write("b.off", text), "--mesh-only");
    EXPECT_TRUE(contains(ended.errors, "note: rounding to float put 1 vertices at the place of another; it moved "
                                       "vertices by at most 1e-11, 5.8e-12 of the bounding box's diagonal"))
        << ended.errors;
}

TEST_F(BuilderProgram, closes_the_gaps_that_triangles_without_area_leave)
{
    // A box with a vertex in the middle of an edge, which only one of the two sides has; a triangle without area joins
    // them.
    const auto ended =
        run_on(write("box.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\n"
                                "v 1 0 0\nf 4 3 2 1\nf 1 2 9\nf 5 6 7 8\nf 1 9 2 6 5\nf 2 3 7 6\n"
                                "f 3 4 8 7\nf 4 1 5 8\n"));
    ASSERT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "note: 1 triangles split where a neighbour has no area"));
    EXPECT_EQ(read_scene(folder_ / "out.tet").mesh.triangles.size(), 14u);
}

TEST_F(BuilderProgram, answers_help_and_version)
{
    EXPECT_EQ(run("--help").code, BUILDER_GOOD);
    EXPECT_EQ(run("--version").code, BUILDER_GOOD);
}

TEST_F(BuilderProgram, refuses_wrong_options_with_code_2)
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

TEST_F(BuilderProgram, refuses_bad_meshes_with_code_5)
{
    const auto ended = run_on(write("a.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_EQ(ended.code, BUILDER_BAD_MESH);
    EXPECT_TRUE(contains(ended.errors, "a.off: vertex 1 (line 4)"));
    EXPECT_EQ(run_on(write("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")).code, BUILDER_BAD_MESH) << "no area";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.tet"));
}

TEST_F(BuilderProgram, reports_missing_files_with_code_3)
{
    EXPECT_EQ(run_on(folder_ / "none.off").code, BUILDER_MISSING_FILE);
    const auto mesh = write("a.off", to_off(tetrahedron()));
    EXPECT_EQ(run("--mesh '" + mesh.string() + "' --out '" + (folder_ / "none" / "out.tet").string() + "'").code,
              BUILDER_MISSING_FILE);
}

TEST_F(BuilderProgram, lists_self_intersections_with_code_10)
{
    const auto ended = run_on(write("a.off", to_off(crossing_pair())));
    EXPECT_EQ(ended.code, BUILDER_SELF_INTERSECTION);
    EXPECT_TRUE(contains(ended.errors, "error:   triangle 1 (1, 1, -1) (1, 1, 1) (2, 1, 1)\n"));
}

TEST_F(BuilderProgram, repairs_crossing_triangles_where_it_is_asked_to)
{
    const TriangleMesh cubes = joined(box({0, 0, 0}, {1, 1, 1}), box({0.5f, 0.25f, 0.375f}, {1.5f, 1.25f, 1.375f}));
    const auto mesh = write("two.off", to_off(cubes));
    EXPECT_TRUE(contains(run_on(mesh).errors, "a repair (without --no-repair) cuts them"));
    for (const std::string how :
         {"", "--domain wide --divisions 1", "--tets rays --switches pY", "--tets rays --switches pY --domain wide"}) {
        const auto ended = run_on(mesh, "--repair " + how);
        ASSERT_EQ(ended.code, BUILDER_GOOD) << how << ended.errors;
        const Scene scene = read_scene(folder_ / "out.tet");
        expect_sound(scene);
        EXPECT_EQ(scene.build.optimised.tets, contains(how, "--tets rays") ? TetsKind::rays : TetsKind::cdt) << how;
        EXPECT_EQ(scene.build.optimised.reason, "");
        const RepairInfo& repair = scene.build.repair;
        EXPECT_TRUE(contains(ended.errors, "note: " + std::to_string(repair.crossing_pairs) + " pairs of triangles "));
        EXPECT_TRUE(repair.asked);
        EXPECT_GT(repair.crossing_pairs, 0u);
        EXPECT_GT(repair.cut_triangles, 5u);
        EXPECT_EQ(scene.origins.size(), scene.mesh.triangles.size());
        for (const std::uint32_t origin : scene.origins)
            EXPECT_LT(origin, cubes.triangles.size());
    }
    const auto sound = run_on(write("ball.off", to_off(sphere(2))), "--repair");
    EXPECT_EQ(sound.code, BUILDER_GOOD);
    EXPECT_FALSE(contains(sound.errors, "cross:")) << "there is nothing to say";
    EXPECT_TRUE(read_scene(folder_ / "out.tet").origins.empty());
}

TEST_F(BuilderProgram, reads_the_mesh_that_a_run_before_prepared)
{
    const TriangleMesh cubes = joined(box({0, 0, 0}, {1, 1, 1}), box({0.5f, 0.25f, 0.375f}, {1.5f, 1.25f, 1.375f}));
    const auto mesh = write("two.off", to_off(cubes));
    const std::string options = "--repair --prepared '" + (folder_ / "prepared").string() + "' --switches ";
    const auto first = run_on(mesh, options + "pY");
    ASSERT_EQ(first.code, BUILDER_GOOD) << first.errors;
    const Scene made = read_scene(folder_ / "out.tet");
    (void)write("two.off", "OFF\n"); // not read again
    const auto second = run_on(mesh, options + "pq5Y --order 2");
    ASSERT_EQ(second.code, BUILDER_GOOD) << second.errors;
    const Scene again = read_scene(folder_ / "out.tet");
    expect_sound(again);
    EXPECT_EQ(again.mesh, made.mesh);
    EXPECT_EQ(again.origins, made.origins);
    EXPECT_EQ(again.build.repair, made.build.repair);
    EXPECT_EQ(again.build.switches, "pq5Y");
    EXPECT_EQ(again.build.order, 2u);
    EXPECT_FALSE(contains(second.errors, "repairing"));
}

TEST_F(BuilderProgram, gives_tetgen_the_mesh_in_any_order)
{
    const auto mesh = write("ball.off", to_off(sphere(4)));
    const auto scene_in = [&](const std::string& order) {
        const auto ended = run_on(mesh, "--order " + order);
        EXPECT_EQ(ended.code, BUILDER_GOOD) << ended.errors;
        Scene scene = read_scene(folder_ / "out.tet");
        expect_sound(scene);
        return scene;
    };
    const Scene first = scene_in("0"), other = scene_in("3"), again = scene_in("3");
    EXPECT_EQ(other.mesh, first.mesh) << "faces keep their numbers";
    EXPECT_NE(other.tets, first.tets);
    EXPECT_EQ(other.tets, again.tets);
    EXPECT_EQ(other.build.order, 3u);
    const Scene coarse = scene_in("203");
    EXPECT_EQ(coarse.mesh, first.mesh);
    EXPECT_EQ(coarse.domain, first.domain) << "only TetGen gets its sides in 2 x 2 squares";
    EXPECT_LT(coarse.tets.tets.size(), first.tets.tets.size());
    EXPECT_EQ(coarse.build.order, 203u);
    EXPECT_EQ(run_on(mesh, "--order 6500").code, BUILDER_USAGE) << "65 squares along a side";
}

TEST_F(BuilderProgram, ends_tetgen_at_its_limit_of_processor_time)
{
    const auto ended = run_on(write("ball.off", to_off(sphere(6))), "--tetgen-for 0.001");
    EXPECT_EQ(ended.code, BUILDER_TETGEN_REFUSED);
    EXPECT_TRUE(contains(ended.errors, "error: the tets were not made within their share of the limit of time"));
}

TEST_F(BuilderProgram, numbers_triangles_as_the_file_does_where_some_are_dropped)
{
    TriangleMesh mesh = tetrahedron();
    mesh.triangles.insert(mesh.triangles.begin() + 1, {0, 0, 1});
    ASSERT_EQ(run_on(write("a.off", to_off(mesh))).code, BUILDER_GOOD);
    EXPECT_EQ(read_scene(folder_ / "out.tet").origins, (std::vector<std::uint32_t>{0, 2, 3, 4}));
}

TEST_F(BuilderProgram, reports_tetgens_refusal_with_code_11)
{
    // Two triangles over one edge, so close to each other that TetGen takes them for one.
    const TriangleMesh hinge{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}, {0.5f, 1, 1e-9f}}, {{0, 1, 2}, {0, 1, 3}}};
    const auto ended = run_on(write("a.off", to_off(hinge)));
    EXPECT_EQ(ended.code, BUILDER_TETGEN_REFUSED) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "error: TetGen gave up with code 3"));
    EXPECT_TRUE(contains(ended.errors, std::string(try_other_switches)));
}

TEST_F(BuilderProgram, reports_exhausted_memory_with_code_13)
{
    if (address_sanitized) GTEST_SKIP() << "AddressSanitizer reserves more address space than any limit";
    const auto mesh = write("a.off", to_off(tetrahedron()));
    std::filesystem::resize_file(mesh, 400u << 20); // a hole: it takes no space on disk
    const auto ended = run_on(mesh, "", "ulimit -v 200000; ");
    EXPECT_EQ(ended.code, BUILDER_OUT_OF_MEMORY) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "out of memory"));
    EXPECT_TRUE(contains(ended.errors, std::string(allow_more_memory)));
}
