// What load_scene() gives for each kind of name, and which options do not concern it.
#include "core/rays/camera_set.h"
#include "scenes/mesh_files.h"
#include "tests/scenes/load_fixture.h"

#include <sys/stat.h>
#include <thread>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

TEST_F(Load, makes_cubes_in_place)
{
    request.name = "cubes";
    request.build = {.resolution = 5};
    std::vector<std::string> stages;
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, auto...) { stages.push_back(stage); });
    EXPECT_EQ(loaded.hash, scene_hash(make_cubes(5)));
    EXPECT_FALSE(loaded.from_cache);
    EXPECT_TRUE(loaded.file.empty());
    EXPECT_TRUE(loaded.messages.empty());
    EXPECT_FALSE(stages.empty());
    EXPECT_EQ(builder_runs(), 0u);
    EXPECT_FALSE(fs::exists(folder / "cache"));
}

TEST_F(Load, makes_a_lattice_of_the_size_that_its_name_has)
{
    request.name = "lattice:5";
    request.build = {};
    const LoadedScene loaded = load();
    EXPECT_EQ(loaded.hash, scene_hash(make_lattice(5)));
    EXPECT_TRUE(loaded.file.empty());
    EXPECT_TRUE(loaded.messages.empty());
    request.build = {.domain = DomainKind::wide, .resolution = 3};
    EXPECT_EQ(load().messages.front(), "scene lattice:5: it is made in place, in a domain of its own: --domain, "
                                       "--resolution are not used");
    EXPECT_EQ(builder_runs(), 0u);
}

TEST_F(Load, reports_which_options_cubes_ignore)
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
    expect_unused({.repair = false}, "--no-repair is");
    expect_unused({.domain = DomainKind::wide, .divisions = 3, .switches = "p"},
                  "--domain, --divisions, --switches are");
}

TEST_F(Load, reports_which_options_a_tet_file_ignores)
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

TEST_F(Load, a_tet_file_of_a_procedural_scene_has_its_views)
{
    Scene scene = read_scene(prepared);
    scene.build.source = "atrium.off";
    request.name = (folder / "packed-rays.tet").string();
    write_scene(request.name, scene);
    EXPECT_TRUE(load().views.empty()) << "of a mesh that has only the name";
    scene.build.source_hash = hash_of_mesh_file(*find_procedural("atrium"));
    write_scene(request.name, scene);
    EXPECT_EQ(load().views.size(), own_view_count);
    scene.build.source_hash = hash_of_mesh_file(*find_procedural("atrium@9000"));
    write_scene(request.name, scene);
    EXPECT_TRUE(load().views.empty()) << "in another size";
}

TEST_F(Load, reports_that_a_mesh_has_no_resolution)
{
    request.build.resolution = 3;
    EXPECT_EQ(load().messages.back(), "scene " + mesh.string() +
                                          ": it is made of a mesh, and only cubes have a resolution: --resolution is "
                                          "not used");
    request.build.resolution = BuildOptions{}.resolution;
    for (const std::string& message : load().messages)
        EXPECT_FALSE(contains(message, "--resolution")) << message;
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
    EXPECT_TRUE(contains(
        error,
        "cubes, banana, bunny, armadillo, atrium, city, terrain, spheres, grass, plant, nested, field, lattice"));
    request.name = folder.path().string();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "invalid_input: reading mesh"));
    write_file(mesh, "");
    request.name = mesh.string();
    EXPECT_TRUE(contains(error_of([&] { (void)load(); }), "it is empty"));
    EXPECT_EQ(builder_runs(), 0u);
}

TEST_F(Load, builds_the_banana_from_its_file)
{
    request.name = "banana";
    const std::string error = error_with("cat \"$2\" > " + (folder / "seen.off").string() + "; exit 11");
    EXPECT_TRUE(contains(error, "building scene banana from "));
    EXPECT_TRUE(read_text(folder / "seen.off").starts_with("OFF\n12502 25000 0\n"));
}

TEST_F(Load, reads_a_pipe_once_and_whole)
{
    const auto pipe = folder / "thing.off";
    std::filesystem::remove(pipe);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(why_not_available(pipe), "");
    std::thread writer([&] { write_file(pipe, mesh_text); });
    EXPECT_EQ(load().hash, scene_hash(expected()));
    writer.join();
    const std::string copy = read_text(folder / "runs");
    EXPECT_TRUE(contains(copy, "--mesh " + (folder / "cache/tetrace/meshes/").string())) << copy;
    EXPECT_TRUE(contains(copy, "/thing.off --out ")) << "with its extension";
    EXPECT_TRUE(load().from_cache) << "nobody writes to it again";
}

TEST_F(Load, copies_what_only_this_process_has_open)
{
    EXPECT_TRUE(is_stream("/proc/self/cmdline"));
    EXPECT_FALSE(is_stream(mesh));
    EXPECT_FALSE(is_stream(folder.path()));
    EXPECT_FALSE(is_stream("/dev/zero"));
    EXPECT_TRUE(
        contains(error_of([] { (void)spooled_mesh("/proc/self/fd/none"); }), "reading mesh /proc/self/fd/none: "));
}

TEST_F(Load, builds_again_where_a_buffer_of_gltf_has_changed)
{
    mesh = folder / "thing.gltf";
    request.name = mesh.string();
    mesh_text = R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:,x"},{"uri":"../thing.off"}]})";
    write_file(mesh, mesh_text);
    for (const std::string buffer : {"first", "second"}) {
        write_file(folder / "a b.bin", buffer);
        Scene made = expected();
        made.build.source_hash = hash_of(mesh_text + buffer);
        write_scene(prepared, made);
        EXPECT_FALSE(load().from_cache) << buffer;
        EXPECT_TRUE(load().from_cache) << buffer;
    }
}
