// Pinned scenes are the same scenes wherever they are loaded, whatever makes tets there.
#include "core/base/cache_home.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/rays/camera_set.h"
#include "scenes/cache.h"
#include "scenes/load.h"
#include "scenes/pinned.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "scenes/stored_tets.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

class PinnedScenes : public testing::Test {
protected:
    LoadedScene load(const std::string& name) const { return load_scene({name, default_build(TetsKind::rays)}, {}); }
    /// A builder that reads meshes, and fails to make tets.
    void let_building_fail()
    {
        write_file(folder_ / "builder.sh", "#!/bin/sh\ncase \"$*\" in *--mesh-only*) exec '" TETRACE_BUILDER_PROGRAM
                                           "' \"$@\";; esac\nexit 4\n");
        std::filesystem::permissions(folder_ / "builder.sh", std::filesystem::perms::owner_all);
        other_builder_.emplace("TETRACE_BUILDER", folder_ / "builder.sh");
    }

    TemporaryFolder folder_;
    ScopedVariable cache_{"XDG_CACHE_HOME", folder_ / "cache"};
    ScopedVariable builder_{"TETRACE_BUILDER", TETRACE_BUILDER_PROGRAM};
    std::optional<ScopedVariable> other_builder_;
};

} // namespace

TEST_F(PinnedScenes, are_joined_from_mesh_and_stored_tets_if_building_fails)
{
    let_building_fail();
    for (const PinnedScene& pinned : pinned_scenes()) {
        if (sanitized && pinned.of != "atrium") continue; // each takes a minute
        const std::string name(pinned.name);
        if (!why_not_available(name).empty()) {
            std::printf("%s: not tested: %s\n", name.c_str(), why_not_available(name).c_str());
            continue;
        }
        const LoadedScene made = load(name);
        EXPECT_EQ(scene_hash(made.scene), pinned.scene_hash) << name;
        EXPECT_EQ(mesh_hash(made.scene.mesh), pinned.mesh_hash) << name;
        EXPECT_EQ(made.scene.build.source_hash, pinned.source_hash) << name;
        EXPECT_EQ(hash_of_cameras(make_cameras(CameraSet::frame, made.scene.mesh, made.views)), pinned.cameras_hash);
        EXPECT_EQ(made.scene.name, pinned.of);
        EXPECT_EQ(made.scene.build.build_s, 0) << "its tets were not made here";
        ASSERT_FALSE(made.messages.empty());
        EXPECT_TRUE(contains(made.messages.back(), "the tets are those of " + name + " that tetrace stores"));
        EXPECT_TRUE(contains(made.messages.at(made.messages.size() - 2),
                             pinned.optimiser == optimiser_version ? "is not made here: making them here failed"
                                                                   : "is not made here: another optimiser made them"));
        const LoadedScene again = load(name);
        EXPECT_TRUE(again.from_cache);
        EXPECT_EQ(again.hash, pinned.scene_hash);
    }
}

TEST_F(PinnedScenes, are_read_from_a_cache_that_cannot_be_written_to)
{
    let_building_fail();
    const LoadedScene made = load("atrium-1");
    // Below a file nobody can write, root neither; the folder is there only later.
    const std::filesystem::path closed = folder_ / "closed";
    write_file(closed, "");
    const ScopedVariable cache("XDG_CACHE_HOME", closed / "cache");
    const CacheHome replaced;
    std::filesystem::remove(closed);
    std::filesystem::create_directories(closed / "cache/tetrace");
    std::filesystem::rename(made.file, closed / "cache/tetrace" / made.file.filename());
    const LoadedScene again = load("atrium-1");
    EXPECT_TRUE(again.from_cache);
    EXPECT_EQ(again.file.parent_path(), closed / "cache/tetrace");
    EXPECT_EQ(again.hash, made.hash);
}

TEST_F(PinnedScenes, are_what_the_optimiser_makes_of_their_mesh)
{
    if (sanitized) GTEST_SKIP() << "the optimiser takes minutes for them under a sanitizer";
    for (const PinnedScene& pinned : pinned_scenes()) {
        const std::string name(pinned.name);
        if (pinned.optimiser != optimiser_version || !why_not_available(name).empty()) continue;
        const LoadedScene built = load(std::string(pinned.of));
        if (!contains(built.scene.build.tool, "TetGen 1.5.")) GTEST_SKIP() << built.scene.build.tool << " may differ";
        EXPECT_EQ(built.hash, pinned.scene_hash)
            << "the optimiser makes other tets than before: raise optimiser_version in scenes/cache.h";
        const LoadedScene same = load(name);
        EXPECT_TRUE(same.from_cache) << "built scenes are taken where they are the pinned ones";
        EXPECT_EQ(same.hash, pinned.scene_hash);
        EXPECT_GT(same.scene.build.build_s, 0);
        EXPECT_EQ(same.views.empty(), pinned.of != "atrium");
    }
}

TEST_F(PinnedScenes, refuse_another_mesh_and_options_that_make_other_tets)
{
    write_file(folder_ / "bunny00.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const ScopedVariable meshes("TETRACE_MESHES", folder_.path());
    const std::string error = error_of([&] { (void)load("bunny-1"); });
    EXPECT_TRUE(contains(error, "bunny00.off is another mesh")) << error;
    EXPECT_TRUE(contains(error, "those of bunny-1 the hash 78924a553c61dc43; name the scene bunny")) << error;
    SceneRequest by_default{"bunny-1", default_build(TetsKind::rays), true};
    by_default.build.mesh_will_do = true;
    const LoadedScene other = load_scene(by_default, {});
    EXPECT_NE(other.hash, find_pinned("bunny-1")->scene_hash);
    EXPECT_TRUE(contains(other.messages.back(), "not bunny-1: ")) << other.messages.back();
    SceneRequest request{"bunny-1", default_build(TetsKind::cdt)};
    EXPECT_TRUE(contains(error_of([&] { (void)load_scene(request, {}); }), "leave out --tets, --effort"));
    EXPECT_TRUE(contains(error_of([&] { (void)load("bunny-2"); }), "neither a name of the catalogue"));
}

TEST_F(PinnedScenes, find_damage_in_stored_tets)
{
    const PinnedScene& pinned = *find_pinned("atrium-1");
    Scene other;
    other.mesh.vertices.resize(3);
    EXPECT_TRUE(contains(error_of([&] { (void)with_stored_tets(other, pinned.tets); }), "they are of another mesh"));
    EXPECT_TRUE(contains(error_of([&] { (void)with_stored_tets(other, pinned.tets.first(1000)); }), "(damaged)"));
    std::vector<std::byte> changed(pinned.tets.begin(), pinned.tets.end());
    changed[changed.size() / 2] ^= std::byte{1};
    EXPECT_TRUE(contains(error_of([&] { (void)with_stored_tets(other, changed); }), "(damaged)"));
    EXPECT_TRUE(contains(error_of([&] { (void)store_tets(make_cubes(2)); }), "storing tets"));
}
