// The builder: how it is found, its arguments, and how each of its ends is reported.
#include "scenes/builder_exit.h"
#include "tests/scenes/load_fixture.h"

#include <csignal>
#include <fmt/format.h>
#include <map>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

TEST_F(Load, finds_the_builder_in_the_search_path_last)
{
    const ScopedVariable unset("TETRACE_BUILDER", nullptr);
    fs::copy_file(builder, folder / "tetrace-builder");
    const ScopedVariable path("PATH", "/no/such/folder:" + folder.path().string());
    const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / "tetrace-builder";
    EXPECT_EQ(find_builder(), fs::exists(beside) ? beside : folder / "tetrace-builder");
}

TEST_F(Load, names_the_package_of_a_missing_builder)
{
    const ScopedVariable none("TETRACE_BUILDER", folder / "none");
    EXPECT_TRUE(find_builder().empty()); // a wrong name is not passed over in silence
    const std::string error = error_of([&] { (void)load(); });
    EXPECT_TRUE(contains(error, "missing: building scene thing"));
    EXPECT_TRUE(contains(error, "libtet1.5-dev"));
    EXPECT_TRUE(contains(error, "libcgal-dev"));
    EXPECT_TRUE(contains(error, "TETRACE_BUILDER names " + (folder / "none").string()));
}

TEST_F(Load, passes_all_options_to_the_builder)
{
    request.build = {.domain = DomainKind::wide, .divisions = 5, .switches = "pq3Y"};
    (void)error_of([&] { (void)load(); });
    const std::string run = read_text(folder / "runs");
    EXPECT_TRUE(contains(run, "--mesh " + mesh.string() + " --out "));
    EXPECT_TRUE(contains(run, " --name thing --domain wide --divisions 5 --switches pq3Y --order 0 --tets cdt --effort "
                              "2 --tetgen-for 150 --optimise-for 300 --repair --weld 0 --prepared "));
}

TEST_F(Load, keeps_repaired_scenes_apart_and_says_what_was_done)
{
    Scene made = expected();
    made.build.repair = {true, 4, 3, 20, 1, 2, 0x1p-20, 0x1p-19};
    write_scene(prepared, made);
    use_builder("");
    (void)load();
    EXPECT_TRUE(contains(read_text(folder / "runs"), "--optimise-for 300 --repair --weld 0 --prepared "));
    const LoadedScene cached = load();
    EXPECT_TRUE(cached.from_cache);
    EXPECT_TRUE(contains(cached.messages.front(), "4 pairs of triangles crossed, and 3 triangles were cut into 20"));
    EXPECT_TRUE(contains(cached.messages.at(1), "the repair moved faces by up to 1.9e-06 to merge near layers"));
    request.build.repair = false;
    EXPECT_TRUE(
        contains(error_with("exit " + std::to_string(BUILDER_SELF_INTERSECTION)), "leave out `--no-repair`, or "));
}

TEST_F(Load, hands_on_stages_and_notes)
{
    use_builder("echo 'stage: reading' >&2; sleep 0.3; echo 'note: 3 vertices merged' >&2; echo 'stage: tetgen' >&2; "
                "sleep 0.3");
    std::vector<std::string> stages;
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, double fraction, const std::string&) {
        stages.push_back(stage);
        EXPECT_LT(fraction, 0);
    });
    EXPECT_EQ(loaded.messages, std::vector<std::string>{"3 vertices merged"});
    for (const std::string start : {"building thing: reading", "building thing: tetgen"})
        EXPECT_TRUE(std::any_of(stages.begin(), stages.end(), [&](const std::string& s) {
            return s.starts_with(start);
        })) << start;
}

TEST_F(Load, maps_each_exit_code_to_its_own_error)
{
    const struct {
        int code;
        const char* kind;
        const char* what;
    } cases[] = {{BUILDER_USAGE, "usage: ", "an option is not accepted"},
                 {BUILDER_BAD_MESH, "invalid_input: ", "the mesh cannot be used"},
                 {BUILDER_MISSING_FILE, "missing: ", "a file is missing"},
                 {BUILDER_INTERNAL, "internal: ", "its own fault"},
                 {BUILDER_SELF_INTERSECTION, "invalid_input: ", "the mesh intersects itself"},
                 {BUILDER_TETGEN_REFUSED, "invalid_input: ", "no tets could be made"},
                 {BUILDER_ABSURD_OUTPUT, "invalid_input: ", "the tets failed the checks"},
                 {BUILDER_OUT_OF_MEMORY, "invalid_input: ", "the builder ran out of memory"},
                 {77, "internal: ", "exit code 77"}};
    for (const auto& c : cases) {
        const std::string error =
            error_with("echo 'stage: tetgen' >&2; echo 'error: the finding' >&2; exit " + std::to_string(c.code));
        EXPECT_TRUE(error.starts_with(c.kind)) << error;
        EXPECT_TRUE(contains(error, c.what));
        for (const char* part : {"building scene thing from ", "switches pq5Y", ": the finding", "last stage: tetgen"})
            EXPECT_TRUE(contains(error, part));
        EXPECT_TRUE(cache_is_clean());
    }
}

TEST_F(Load, gives_only_the_mesh_if_only_tetgen_fails_and_the_mesh_is_enough)
{
    Scene mesh_alone = expected();
    mesh_alone.tets = {};
    write_scene(folder / "mesh.tet", mesh_alone);
    const std::string alone =
        "case \"$*\" in *--mesh-only*) cp " + (folder / "mesh.tet").string() + " \"$4\"; exit 0;; esac; ";
    request.build.switches = "p"; // no others are tried
    request.build.mesh_will_do = true;
    for (const std::string& failure :
         {"exit " + std::to_string(BUILDER_TETGEN_REFUSED), "exit " + std::to_string(BUILDER_ABSURD_OUTPUT),
          "exit " + std::to_string(BUILDER_OUT_OF_MEMORY), "exit " + std::to_string(BUILDER_SELF_INTERSECTION),
          std::string("kill -SEGV $$"), std::string("sleep 60")}) {
        request.build.time_limit_s = failure == "sleep 60" ? 0.3 : 600;
        use_builder(alone + failure);
        for (int run = 0; run < 2; ++run) { // it is not cached
            const std::size_t before = builder_runs();
            const LoadedScene loaded = load();
            EXPECT_EQ(builder_runs(), before + 2) << failure;
            ASSERT_TRUE(loaded.no_tets) << failure;
            EXPECT_TRUE(contains(loaded.no_tets->what(), "building scene thing from ")) << loaded.no_tets->what();
            EXPECT_EQ(loaded.scene, mesh_alone);
            EXPECT_EQ(loaded.hash, scene_hash(mesh_alone));
            EXPECT_TRUE(loaded.file.empty());
        }
        request.build.mesh_will_do = false;
        EXPECT_EQ(error_of([&] { (void)load(); }).find("invalid_input: building scene thing"), 0u) << failure;
        request.build.mesh_will_do = true;
    }
    request.build.time_limit_s = 600;
    use_builder("case \"$*\" in *--repair*) exit " + std::to_string(BUILDER_SELF_INTERSECTION) + ";; esac; " + alone);
    EXPECT_TRUE(load().no_tets) << "a repair without end: the mesh as it is";
    request.build.time_limit_s = 0.3;
    use_builder("case \"$*\" in *--repair*) echo 'stage: repairing, pass 1: 9 pairs cross' >&2; sleep 60;; esac; " +
                alone);
    EXPECT_TRUE(load().no_tets) << "a repair that takes too long";
    use_builder("case \"$*\" in *--repair*) echo 'stage: repairing, pass 1' >&2; kill -ABRT $$;; esac; " + alone);
    const std::size_t runs = builder_runs();
    EXPECT_TRUE(load().no_tets) << "a repair that crashes";
    EXPECT_EQ(builder_runs(), runs + 2) << "it is not TetGen's failure";
    request.build.time_limit_s = 600;
    request.build.repair = false;
    for (const int code : {BUILDER_BAD_MESH, BUILDER_INTERNAL, BUILDER_USAGE})
        EXPECT_NE(error_with(alone + "exit " + std::to_string(code)), "") << "not TetGen's fault";
    EXPECT_TRUE(contains(error_with("exit " + std::to_string(BUILDER_TETGEN_REFUSED)), "no tets could be made"))
        << "and the mesh by itself fails, too";
}

TEST_F(Load, gives_a_remedy_where_the_builder_has_none)
{
    for (const int code : {BUILDER_BAD_MESH, BUILDER_SELF_INTERSECTION, BUILDER_TETGEN_REFUSED, BUILDER_ABSURD_OUTPUT})
        EXPECT_TRUE(contains(error_with("exit " + std::to_string(code)), "repair the mesh"));
}

TEST_F(Load, says_each_remedy_once)
{
    const std::pair<int, std::string> cases[] = {{BUILDER_TETGEN_REFUSED, std::string(try_other_switches)},
                                                 {BUILDER_ABSURD_OUTPUT, std::string(try_other_switches)},
                                                 {BUILDER_OUT_OF_MEMORY, std::string(allow_more_memory)}};
    for (const auto& [code, remedy] : cases) {
        const std::string exit = "exit " + std::to_string(code);
        for (const std::string& script : {"echo \"error: a finding; " + remedy + "\" >&2; " + exit, exit}) {
            const std::string error = error_with(script);
            EXPECT_TRUE(contains(error, remedy));
            EXPECT_EQ(error.find(remedy), error.rfind(remedy)) << error;
            EXPECT_EQ(error.find("switches ("), error.rfind("switches (")) << error;
        }
    }
}

TEST_F(Load, sets_a_scene_apart_whose_optimiser_was_stopped)
{
    request.build = default_build(TetsKind::rays);
    request.build.divisions = 3;
    Scene made = expected();
    made.domain = make_cubes(3).domain;
    made.build.switches = request.build.switches;
    made.build.optimised = {TetsKind::rays, TetsKind::rays, "", request.build.effort, 2, 1, 0.1};
    for (const OptimiserEnd end : {OptimiserEnd::out_of_time, OptimiserEnd::interrupted}) {
        made.build.optimised.end = end;
        write_scene(prepared, made);
        use_builder("");
        const LoadedScene loaded = load();
        EXPECT_NE(loaded.file, cached());
        EXPECT_FALSE(std::filesystem::exists(cached())) << "it is not the scene of that key";
        EXPECT_TRUE(contains(loaded.messages.front(), "stopped early (" + std::string(name_of(end)) + ")"));
        EXPECT_EQ(load_scene({loaded.file.string(), {}}, {}).hash, loaded.hash) << "--scene takes it";
        const auto listed = list_cache();
        EXPECT_TRUE(std::ranges::any_of(listed, [&](const CachedFile& file) { return file.path == loaded.file; }));
    }
    EXPECT_FALSE(load().from_cache);
    write_scene(cached(), made); // as somebody may have copied it
    EXPECT_TRUE(contains(load().messages.front(), "its optimiser was stopped early; built again"));
    EXPECT_GT(clear_cache(), 0u);
    EXPECT_TRUE(list_cache().empty());
}

TEST_F(Load, says_each_time_where_the_tets_are_still_tetgens)
{
    request.build = default_build(TetsKind::rays);
    request.build.divisions = 3;
    Scene made = expected();
    made.build.optimised = {
        TetsKind::rays, TetsKind::cdt, "the optimiser found nothing to better", request.build.effort, 2, 2, 0.1};
    write_scene(prepared, made);
    use_builder("echo \"note: TetGen's tets are used: the optimiser found nothing to better\" >&2");
    EXPECT_EQ(load().messages,
              std::vector<std::string>{"TetGen's tets are used: the optimiser found nothing to better"});
    const LoadedScene cached = load();
    EXPECT_TRUE(cached.from_cache);
    EXPECT_EQ(cached.messages.front(), "the tets are TetGen's: the optimiser found nothing to better");
}

TEST_F(Load, gives_the_optimiser_half_of_the_builders_time_by_default)
{
    (void)load();
    EXPECT_TRUE(contains(read_text(folder / "runs"), "--optimise-for 300 "));
    request.build.optimise_s = 7;
    request.build.divisions = 3;
    clear_cache();
    (void)load();
    EXPECT_TRUE(contains(read_text(folder / "runs"), "--optimise-for 7 "));
}

TEST_F(Load, shows_the_builders_progress)
{
    use_builder("echo 'stage: optimising' >&2; echo 'progress: 0.25 round 2: as far' >&2; sleep 0.3");
    std::vector<std::string> told;
    (void)load_scene(request, [&](const std::string& stage, double fraction, const std::string& detail) {
        if (fraction == 0.25) told.push_back(stage + ", " + detail);
    });
    EXPECT_TRUE(std::ranges::find(told, "building thing: optimising, round 2: as far") != told.end());
    clear_cache();
    use_builder("echo 'stage: optimising' >&2; echo 'progress: none' >&2; sleep 0.3");
    (void)load_scene(request, [&](const std::string& stage, double fraction, const std::string&) {
        EXPECT_TRUE(stage != "building thing: optimising" || fraction < 0);
    });
}

TEST_F(Load, tries_other_switches_where_tetgen_fails_on_tets_for_rays)
{
    request.build = default_build(TetsKind::rays);
    Scene made = expected();
    request.build.divisions = 3;
    made.domain = make_cubes(3).domain;
    made.build.switches = "pY0/2/2";
    made.build.order = 1;
    made.build.optimised = {TetsKind::rays, TetsKind::rays, "", request.build.effort, 2, 1, 0.1};
    write_scene(prepared, made);
    use_builder("eval file=\\${$#}\n" // the last argument
                "if [ ! -e \"$file\" ]; then touch \"$file\"; echo 'note: 4 pairs of triangles crossed' >&2; fi\n"
                "echo 'stage: TetGen' >&2\n"
                "case \"$*\" in *'--switches pY0/2/2 --order 1 '*) ;; *) kill -SEGV $$;; esac");
    const LoadedScene loaded = load();
    EXPECT_EQ(loaded.scene.build.switches, "pY0/2/2");
    ASSERT_FALSE(loaded.messages.empty());
    EXPECT_TRUE(contains(loaded.messages.front(), "TetGen failed with switches pY (the builder crashed"));
    EXPECT_TRUE(contains(loaded.messages.front(), "; trying others"));
    EXPECT_TRUE(contains(loaded.messages.at(1), "with switches pY0/2/2 in order 1, at attempt 5"));
    const LoadedScene again = load();
    EXPECT_TRUE(again.from_cache);
    EXPECT_TRUE(contains(again.messages.front(), "made with pY0/2/2, since TetGen's switches pY failed"));
    EXPECT_TRUE(contains(loaded.messages.at(2), "4 pairs of triangles crossed"));
    request.build.switches = "pYM"; // the user's own: no others are tried
    use_builder("case \"$*\" in *'--switches pYM '*) kill -SEGV $$;; esac");
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "crashed (signal 11"));
}

TEST_F(Load, says_where_cgal_made_the_tets_that_tetgen_could_not)
{
    request.build = default_build(TetsKind::cdt);
    request.build.divisions = 4;
    Scene made = expected();
    made.domain = make_cubes(4).domain;
    made.build.switches = cgal_switches;
    write_scene(prepared, made);
    use_builder("case \"$*\" in *'--switches cgal '*) ;; *) exit 11;; esac");
    const LoadedScene loaded = load();
    EXPECT_EQ(loaded.scene.build.switches, cgal_switches);
    EXPECT_TRUE(contains(loaded.messages.at(0), "TetGen failed with switches pq5Y (no tets could be made); trying"));
    EXPECT_TRUE(contains(loaded.messages.at(1), "CGAL made the tets, at attempt "));
    const LoadedScene again = load();
    EXPECT_TRUE(again.from_cache);
    EXPECT_TRUE(contains(again.messages.front(), "made by CGAL, since TetGen's switches pq5Y failed"));
}

TEST_F(Load, tries_all_other_ways_and_says_how_many_where_none_helps)
{
    request.build = default_build(TetsKind::cdt);
    request.build.divisions = 5;
    const std::string refused = std::to_string(BUILDER_TETGEN_REFUSED);
    const std::string error = error_with("exit " + refused);
    const auto attempts = fallback_attempts(request.build);
    EXPECT_TRUE(contains(error, fmt::format("with switches pq5Y and {} other ways, the last pMT1e-13: no tets could be "
                                            "made",
                                            attempts.size() - 1)))
        << error;
    EXPECT_EQ(attempts.front(), (TetsAttempt{"pq5Y0/2/2"}));
    BuildOptions rays = default_build(TetsKind::rays);
    const auto is_welded = [](const TetsAttempt& attempt) { return attempt.weld > 0; };
    EXPECT_TRUE(std::ranges::any_of(fallback_attempts(rays), is_welded));
    EXPECT_EQ(fallback_attempts(rays).at(0), (TetsAttempt{"pYO0"})) << "TetGen's own optimiser may take all the time";
    EXPECT_EQ(fallback_attempts(rays).at(1), (TetsAttempt{"pYT1e-13O0"}));
    EXPECT_TRUE(std::ranges::any_of(fallback_attempts(rays), [&](const TetsAttempt& attempt) {
        return is_welded(attempt) && attempt.switches == "pq5Y0/2/2";
    })) << "some meshes get tets only by the CDT's switches";
    EXPECT_TRUE(std::ranges::count(fallback_attempts(rays), TetsAttempt{"p", 2}))
        << "others by a plain CDT in some order";
    const auto order = fallback_attempts(rays);
    EXPECT_EQ(std::ranges::find_if(order, is_welded) - order.begin(), 7)
        << "without TetGen's optimiser, in five orders";
    EXPECT_LT(std::ranges::find_if(order, is_welded), std::ranges::find(order, TetsAttempt{"pq5Y"}))
        << "these may take all that is left of the time";
    const auto in_other_squares = [](const TetsAttempt& attempt) { return attempt.order >= 100; };
    EXPECT_LT(std::ranges::find_if(order, in_other_squares), std::ranges::find(order, TetsAttempt{"pq5Y"}))
        << "TetGen fails quickly on some meshes in any order, and makes tets at once of others of the domain's sides";
    rays.repair = false;
    EXPECT_TRUE(std::ranges::none_of(fallback_attempts(rays), is_welded)) << "only a repair may move vertices";
    rays.switches = "pq2";
    EXPECT_TRUE(fallback_attempts(rays).empty()) << "the user's own";
    EXPECT_TRUE(contains(error_with("exit " + std::to_string(BUILDER_SELF_INTERSECTION)), "with switches pq5Y: "))
        << "other switches do not help";
}

TEST_F(Load, repairs_in_vain_once_at_each_tolerance)
{
    request.build = default_build(TetsKind::rays);
    (void)error_with(fmt::format("case \"$*\" in *'--weld 9.5367431640625e-07 '*) exit {};; esac\nexit {}",
                                 int{BUILDER_SELF_INTERSECTION}, int{BUILDER_TETGEN_REFUSED}));
    std::map<double, std::size_t> runs;
    const auto attempts = fallback_attempts(request.build);
    for (const TetsAttempt& attempt : attempts)
        ++runs[attempt.weld];
    EXPECT_GT(runs[0x1p-20], 1u);
    EXPECT_EQ(builder_runs(), 1 + attempts.size() - (runs[0x1p-20] - 1)) << "in any order the repair is the same";
}

TEST_F(Load, reports_a_crash)
{
    const std::string error = error_with("echo 'stage: tetgen' >&2; echo 'Assertion x failed' >&2; kill -SEGV $$");
    EXPECT_TRUE(contains(error, "invalid_input: building scene thing"));
    EXPECT_TRUE(contains(error, "crashed (signal 11"));
    EXPECT_TRUE(contains(error, "Assertion x failed"));
    EXPECT_TRUE(contains(error, "--switches"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, reports_a_hang)
{
    request.build.time_limit_s = 0.3;
    const std::string error = error_with("echo 'stage: tetgen' >&2; sleep 60");
    EXPECT_TRUE(contains(error, "invalid_input: building scene thing"));
    EXPECT_TRUE(contains(error, "limit of 0.3 s of processor time"));
    EXPECT_TRUE(contains(error, "--time-limit"));
    EXPECT_TRUE(contains(error, "last stage: tetgen"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, reports_an_interrupt)
{
    struct sigaction before {
    }, ours{};
    ours.sa_handler = SIG_DFL; // whoever runs the tests may have it ignored
    ::sigaction(SIGINT, &ours, &before);
    std::thread sender;
    use_builder("echo 'stage: tetgen' >&2; sleep 60");
    const std::string error = error_of([&] {
        (void)load_scene(request, [&](const std::string& stage, double, const std::string&) {
            if (!sender.joinable() && stage.find("tetgen") != std::string::npos)
                sender = std::thread([] { ::kill(::getpid(), SIGINT); });
        });
    });
    sender.join();
    ::sigaction(SIGINT, &before, nullptr);
    EXPECT_TRUE(contains(error, "interrupted: building scene thing"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, reads_a_large_mesh_in_pieces)
{
    constexpr std::uintmax_t large = std::uintmax_t{400} << 20; // a sparse file
    std::filesystem::resize_file(mesh, large);
    const auto max_bytes = [] {
        rusage usage{};
        ::getrusage(RUSAGE_SELF, &usage);
        return static_cast<std::uintmax_t>(usage.ru_maxrss) << 10;
    };
    const std::uintmax_t before = max_bytes();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "another mesh"));
    EXPECT_LT(max_bytes(), before + large / 2) << "the memory limit is only the builder's";
}

TEST_F(Load, trusts_no_builder_that_reports_success)
{
    EXPECT_TRUE(contains(error_with("exit 0"), "internal: building scene thing"));
    EXPECT_TRUE(contains(error_with("exit 0"), "the file does not exist"));
    EXPECT_TRUE(contains(error_with("echo garbage > \"$4\"; exit 0"), "section `header`"));
    Scene other = expected();
    other.build.source_hash ^= 1;
    write_scene(folder / "other.tet", other);
    EXPECT_TRUE(contains(error_with("cp " + (folder / "other.tet").string() + " \"$4\"; exit 0"), "another mesh"));
    EXPECT_TRUE(cache_is_clean());
}
