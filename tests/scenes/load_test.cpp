#include "scenes/load.h"

#include "core/base/hash.h"
#include "scenes/build_scene.h"
#include "scenes/builder_exit.h"
#include "scenes/cache.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

/// Builders here are shell scripts: $2 is the mesh, $4 the output, $6 the name.
class Load : public ::testing::Test {
protected:
    Load()
    {
        write_file(mesh, mesh_text);
        request.name = mesh.string();
        request.build.divisions = 3;
        write_scene(prepared, expected());
        use_builder("");
    }

    /// What a builder would make of the mesh: the cubes, told to come from it.
    [[nodiscard]] Scene expected() const
    {
        Scene scene = make_cubes(3);
        scene.name = "thing";
        scene.build.source_hash = hash_of(mesh_text);
        scene.build.switches = request.build.switches;
        scene.build.duplicate_triangles = 2;
        return scene;
    }
    /// A builder that says that it ran, does as the script says, then gives the prepared scene.
    void use_builder(const std::string& script) const
    {
        const std::string log = "echo \"$*\" >> " + (folder / "runs").string();
        write_file(builder, "#!/bin/sh\n" + log + "\n" + script + "\ncp " + prepared.string() + " \"$4\"\n");
        fs::permissions(builder, fs::perms::owner_all);
    }
    [[nodiscard]] std::size_t builder_runs() const
    {
        const std::string log = read_text(folder / "runs");
        return static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n'));
    }
    [[nodiscard]] LoadedScene load() const { return load_scene(request, {}); }
    /// The error with a builder that does this.
    [[nodiscard]] std::string error_with(const std::string& script) const
    {
        use_builder(script);
        return error_of([&] { (void)load(); });
    }
    [[nodiscard]] fs::path cached() const { return cached_scene_path("thing", hash_of(mesh_text), request.build); }
    /// No work folder, no lock, no scene.
    [[nodiscard]] bool cache_is_clean() const
    {
        std::error_code ignored; // no folder is clean too
        return fs::is_empty(folder / "cache/tetrace", ignored) || ignored;
    }

    TemporaryFolder folder;
    ScopedVariable xdg{"XDG_CACHE_HOME", folder / "cache"};
    fs::path builder = folder / "builder.sh", prepared = folder / "prepared.tet", mesh = folder / "thing.off";
    ScopedVariable chosen{"TETRACE_BUILDER", builder};
    std::string mesh_text = "OFF, as far as a shell script cares";
    SceneRequest request;
};

} // namespace

TEST_F(Load, makes_cubes_in_place)
{
    request.name = "cubes";
    request.build = {.resolution = 5};
    std::vector<std::string> stages;
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, double) { stages.push_back(stage); });
    EXPECT_EQ(loaded.hash, scene_hash(make_cubes(5)));
    EXPECT_FALSE(loaded.from_cache);
    EXPECT_TRUE(loaded.file.empty());
    EXPECT_TRUE(loaded.messages.empty());
    EXPECT_FALSE(stages.empty());
    EXPECT_EQ(builder_runs(), 0u);
    EXPECT_FALSE(fs::exists(folder / "cache"));
}

TEST_F(Load, tells_which_options_cubes_do_not_heed)
{
    request.name = "cubes";
    const auto expect_unused = [&](const BuildOptions& options, const std::string& unused) {
        request.build = options;
        EXPECT_EQ(load().messages,
                  std::vector<std::string>{"scene cubes: it is made in place, in a domain of its own: " + unused +
                                           " not used"});
    };
    expect_unused({.domain = DomainKind::wide, .resolution = 3}, "--domain is");
    expect_unused({.divisions = 3}, "--divisions is");
    expect_unused({.switches = "p"}, "--switches is");
    expect_unused({.domain = DomainKind::wide, .divisions = 3, .switches = "p"},
                  "--domain, --divisions, --switches are");
}

TEST_F(Load, tells_which_options_a_tet_file_does_not_heed)
{
    request.name = prepared.string();
    const auto expect_unused = [&](const BuildOptions& options, const std::string& unused) {
        request.build = options;
        EXPECT_EQ(load().messages, std::vector<std::string>{"scene " + request.name +
                                                            ": the file is its own scene: " + unused + " not used"});
    };
    expect_unused({.domain = DomainKind::wide}, "--domain is");
    expect_unused({.divisions = 3}, "--divisions is");
    expect_unused({.switches = "p"}, "--switches is");
    expect_unused({.resolution = 3}, "--resolution is");
    request.build = {};
    EXPECT_TRUE(load().messages.empty());
}

TEST_F(Load, tells_that_a_mesh_has_no_resolution)
{
    request.build.resolution = 3;
    EXPECT_EQ(load().messages.back(), "scene " + mesh.string() +
                                          ": it is made of a mesh, and only cubes have a resolution: --resolution is "
                                          "not used");
    request.build.resolution = BuildOptions{}.resolution;
    for (const std::string& message : load().messages)
        EXPECT_FALSE(contains(message, "--resolution")) << message;
}

TEST_F(Load, builds_a_mesh_once_and_then_finds_it_in_the_cache)
{
    const LoadedScene built = load();
    EXPECT_EQ(built.scene, expected());
    EXPECT_EQ(built.hash, scene_hash(expected()));
    EXPECT_FALSE(built.from_cache);
    EXPECT_EQ(built.file, cached());
    const LoadedScene found = load();
    EXPECT_EQ(found.scene, expected());
    EXPECT_TRUE(found.from_cache);
    ASSERT_EQ(found.messages.size(), 1u);
    EXPECT_TRUE(contains(found.messages[0], "2 duplicate triangles were removed"));
    EXPECT_EQ(builder_runs(), 1u);
    EXPECT_EQ(list_cache().size(), 1u);
    EXPECT_FALSE(fs::exists(cached().string() + ".lock"));
}

TEST_F(Load, tells_the_builder_all_that_was_asked)
{
    request.build = {.domain = DomainKind::wide, .divisions = 5, .switches = "pq3Y"};
    (void)error_of([&] { (void)load(); });
    const std::string run = read_text(folder / "runs");
    EXPECT_TRUE(contains(run, "--mesh " + mesh.string() + " --out "));
    EXPECT_TRUE(contains(
        run, " --name thing --domain wide --divisions 5 --switches pq3Y --tets cdt --effort 2 --optimise-for 300\n"));
}

TEST_F(Load, hands_on_stages_and_notes)
{
    use_builder("echo 'stage: reading' >&2; sleep 0.3; echo 'note: 3 vertices merged' >&2; echo 'stage: tetgen' >&2; "
                "sleep 0.3");
    std::vector<std::string> stages;
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, double fraction) {
        stages.push_back(stage);
        EXPECT_LT(fraction, 0);
    });
    EXPECT_EQ(loaded.messages, std::vector<std::string>{"3 vertices merged"});
    for (const std::string start : {"building thing: reading", "building thing: tetgen"})
        EXPECT_TRUE(std::any_of(stages.begin(), stages.end(), [&](const std::string& s) {
            return s.starts_with(start);
        })) << start;
}

TEST_F(Load, reads_a_tet_file_of_the_user_without_building)
{
    request.name = prepared.string();
    const LoadedScene loaded = load();
    EXPECT_EQ(loaded.scene, expected());
    EXPECT_EQ(loaded.file, prepared);
    EXPECT_FALSE(loaded.from_cache);
    EXPECT_EQ(builder_runs(), 0u);
}

TEST_F(Load, refuses_a_damaged_tet_file_of_the_user)
{
    const std::string bytes = read_text(prepared);
    write_file(prepared, bytes.substr(0, bytes.size() - 1));
    request.name = prepared.string();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "invalid_input: reading scene " + prepared.string()));
    EXPECT_EQ(builder_runs(), 0u);
}

TEST_F(Load, refuses_a_name_that_is_neither_row_nor_file)
{
    request.name = "bunni";
    const std::string error = error_of([&] { (void)load(); });
    EXPECT_TRUE(contains(error, "usage: scene bunni"));
    EXPECT_TRUE(contains(error, "cubes, banana, bunny, armadillo"));
    request.name = folder.path().string();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "invalid_input: reading mesh"));
    write_file(mesh, "");
    request.name = mesh.string();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "it is empty"));
    EXPECT_EQ(builder_runs(), 0u);
}

TEST_F(Load, says_so_and_builds_again_where_the_cache_s_file_is_damaged)
{
    (void)load();
    const std::string good = read_text(cached());
    const std::string foreign = "OFF, put here by somebody";
    for (const std::string& bad : {good.substr(0, good.size() / 2), std::string(), foreign, good + "x"}) {
        write_file(cached(), bad);
        const LoadedScene loaded = load();
        EXPECT_EQ(loaded.scene, expected());
        EXPECT_FALSE(loaded.from_cache);
        ASSERT_EQ(loaded.messages.size(), 1u);
        EXPECT_TRUE(contains(loaded.messages[0], cached().string()));
        EXPECT_TRUE(contains(loaded.messages[0], "built again"));
        EXPECT_EQ(read_text(cached()), good);
    }
    EXPECT_EQ(builder_runs(), 5u);
}

TEST_F(Load, builds_again_where_another_scene_lies_in_the_cache_s_place)
{
    (void)load();
    Scene other = expected();
    other.build.source_hash ^= 1;
    write_scene(cached(), other);
    EXPECT_TRUE(contains(load().messages.at(0), "made from another mesh"));
    other = expected();
    other.build.switches = "p";
    write_scene(cached(), other);
    EXPECT_TRUE(contains(load().messages.at(0), "made with the switches p, not pq5Y"));
    EXPECT_EQ(builder_runs(), 3u);
    EXPECT_TRUE(load().from_cache);
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
                 {BUILDER_TETGEN_REFUSED, "invalid_input: ", "TetGen refused the mesh"},
                 {BUILDER_ABSURD_OUTPUT, "invalid_input: ", "TetGen's output failed the checks"},
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

TEST_F(Load, tries_other_switches_where_tetgen_fails_on_tets_for_rays)
{
    request.build = default_build(TetsKind::rays);
    Scene made = expected();
    made.domain = make_cubes(3).domain; // three divisions
    made.build.switches = "pq5Y";
    made.build.optimised = {TetsKind::rays, TetsKind::rays, "", request.build.effort, 2, 1, 0.1};
    write_scene(prepared, made);
    use_builder("case \"$*\" in *'--switches pY '*) kill -SEGV $$;; esac");
    const LoadedScene loaded = load();
    EXPECT_EQ(loaded.scene.build.switches, "pq5Y");
    ASSERT_FALSE(loaded.messages.empty());
    EXPECT_TRUE(contains(loaded.messages.front(), "TetGen failed with switches pY; built with pq5Y instead"));
    EXPECT_TRUE(load().from_cache);
    request.build.switches = "pYM"; // the user's own: no others are tried
    use_builder("case \"$*\" in *'--switches pYM '*) kill -SEGV $$;; esac");
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "crashed (signal 11"));
}

TEST_F(Load, tells_a_crash)
{
    const std::string error = error_with("echo 'stage: tetgen' >&2; echo 'Assertion x failed' >&2; kill -SEGV $$");
    EXPECT_TRUE(contains(error, "invalid_input: building scene thing"));
    EXPECT_TRUE(contains(error, "crashed (signal 11"));
    EXPECT_TRUE(contains(error, "Assertion x failed"));
    EXPECT_TRUE(contains(error, "--switches"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, tells_a_hang)
{
    request.build.time_limit_s = 0.3;
    const std::string error = error_with("echo 'stage: tetgen' >&2; sleep 60");
    EXPECT_TRUE(contains(error, "invalid_input: building scene thing"));
    EXPECT_TRUE(contains(error, "time limit of 0.3 s"));
    EXPECT_TRUE(contains(error, "--time-limit"));
    EXPECT_TRUE(contains(error, "last stage: tetgen"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, tells_an_interrupt)
{
    struct sigaction before {
    }, ours{};
    ours.sa_handler = SIG_DFL; // whoever runs the tests may have it ignored
    ::sigaction(SIGINT, &ours, &before);
    std::thread sender;
    use_builder("echo 'stage: tetgen' >&2; sleep 60");
    const std::string error = error_of([&] {
        (void)load_scene(request, [&](const std::string& stage, double) {
            if (!sender.joinable() && stage.find("tetgen") != std::string::npos)
                sender = std::thread([] { ::kill(::getpid(), SIGINT); });
        });
    });
    sender.join();
    ::sigaction(SIGINT, &before, nullptr);
    EXPECT_TRUE(contains(error, "interrupted: building scene thing"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, trusts_no_builder_that_reports_success)
{
    EXPECT_TRUE(contains(error_with("exit 0"), "internal: building scene thing"));
    EXPECT_TRUE(contains(error_with("exit 0"), "there is no such file"));
    EXPECT_TRUE(contains(error_with("echo garbage > \"$4\"; exit 0"), "section `header`"));
    Scene other = expected();
    other.build.source_hash ^= 1;
    write_scene(folder / "other.tet", other);
    EXPECT_TRUE(contains(error_with("cp " + (folder / "other.tet").string() + " \"$4\"; exit 0"), "another mesh"));
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, names_what_brings_a_missing_builder)
{
    const ScopedVariable none("TETRACE_BUILDER", folder / "none");
    EXPECT_TRUE(find_builder().empty()); // a wrong name is not passed over in silence
    const std::string error = error_of([&] { (void)load(); });
    EXPECT_TRUE(contains(error, "missing: building scene thing"));
    EXPECT_TRUE(contains(error, "libtet1.5-dev"));
    EXPECT_TRUE(contains(error, "libcgal-dev"));
    EXPECT_TRUE(contains(error, "TETRACE_BUILDER names " + (folder / "none").string()));
}

TEST_F(Load, finds_the_builder_in_the_search_path_last)
{
    const ScopedVariable unset("TETRACE_BUILDER", nullptr);
    fs::copy_file(builder, folder / "tetrace-builder");
    const ScopedVariable path("PATH", "/no/such/folder:" + folder.path().string());
    const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / "tetrace-builder";
    EXPECT_EQ(find_builder(), fs::exists(beside) ? beside : folder / "tetrace-builder");
}

TEST_F(Load, lets_the_second_of_two_processes_wait_for_the_first)
{
    use_builder("sleep 1");
    const pid_t other = ::fork();
    ASSERT_GE(other, 0);
    if (other == 0) {
        const std::string error = error_of([&] { ::_exit(load().scene == expected() ? 0 : 1); });
        std::fprintf(stderr, "%s\n", error.c_str());
        ::_exit(2);
    }
    while (builder_runs() == 0)
        ::usleep(1000);
    bool waited = false;
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, double) {
        waited = waited || stage.find("waiting for another process") != std::string::npos;
    });
    int status = -1;
    ASSERT_EQ(::waitpid(other, &status, 0), other);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(loaded.scene, expected());
    EXPECT_TRUE(loaded.from_cache);
    EXPECT_TRUE(waited);
    EXPECT_EQ(builder_runs(), 1u);
}

TEST_F(Load, builds_itself_where_the_first_of_two_processes_is_killed)
{
    const auto stuck = folder / "stuck"; // made by the first builder, which then does not end; the second one works
    use_builder("[ -e " + stuck.string() + " ] || { touch " + stuck.string() + "; exec sleep 60; }");
    const pid_t other = ::fork();
    ASSERT_GE(other, 0);
    if (other == 0) {
        (void)error_of([&] { (void)load(); });
        ::_exit(0);
    }
    while (!std::filesystem::exists(stuck))
        ::usleep(1000);
    std::thread killer([&] {
        ::usleep(300000);
        ::kill(other, SIGKILL);
    });
    const LoadedScene loaded = load();
    killer.join();
    ::waitpid(other, nullptr, 0);
    EXPECT_EQ(loaded.scene, expected());
    EXPECT_EQ(builder_runs(), 2u);
    // What the killed one left behind is listed and can be cleared.
    EXPECT_EQ(list_cache().size(), 2u);
    (void)clear_cache();
    EXPECT_TRUE(cache_is_clean());
}

TEST_F(Load, builds_the_banana_from_its_file)
{
    request.name = "banana";
    const std::string error = error_with("cat \"$2\" > " + (folder / "seen.off").string() + "; exit 11");
    EXPECT_TRUE(contains(error, "building scene banana from "));
    EXPECT_TRUE(read_text(folder / "seen.off").starts_with("OFF\n12502 25000 0\n"));
}
