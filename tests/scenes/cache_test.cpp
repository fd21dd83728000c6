#include "scenes/cache.h"

#include "core/base/files.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/support/temporary_folder.h"

#include <csignal>
#include <iterator>
#include <set>
#include <span>
#include <sys/wait.h>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

class Cache : public ::testing::Test {
protected:
    TemporaryFolder folder;
    ScopedVariable home{"HOME", folder / "home"};
    ScopedVariable xdg{"XDG_CACHE_HOME", folder / "xdg"};
    fs::path cache = folder / "xdg" / "tetrace";
    const std::string key = "-0123456789abcdef.tet";

    [[nodiscard]] std::set<std::string> listed() const
    {
        std::set<std::string> names;
        for (const CachedFile& file : list_cache())
            names.insert(file.path.lexically_relative(cache).string());
        return names;
    }
};

} // namespace

TEST_F(Cache, lies_where_xdg_says)
{
    EXPECT_EQ(cache_directory(), cache);
    const ScopedVariable unset("XDG_CACHE_HOME", nullptr);
    EXPECT_EQ(cache_directory(), folder / "home" / ".cache" / "tetrace");
    const ScopedVariable relative("XDG_CACHE_HOME", "relative/path");
    EXPECT_EQ(cache_directory(), folder / "home" / ".cache" / "tetrace");
    const ScopedVariable empty("XDG_CACHE_HOME", "");
    EXPECT_EQ(cache_directory(), folder / "home" / ".cache" / "tetrace");
    const ScopedVariable homeless("HOME", nullptr);
    EXPECT_TRUE(contains(error_of([] { (void)cache_directory(); }), "missing: looking for the cache"));
}

TEST_F(Cache, names_a_scene_by_all_that_decides_its_tets)
{
    const BuildOptions standard;
    std::set<fs::path> paths = {cached_scene_path("bunny", 1, standard)};
    const auto is_new = [&](const std::string& label, std::uint64_t mesh, const BuildOptions& options) {
        return paths.insert(cached_scene_path(label, mesh, options)).second;
    };
    EXPECT_FALSE(is_new("bunny", 1, standard));
    EXPECT_TRUE(is_new("hare", 1, standard));
    EXPECT_TRUE(is_new("bunny", 2, standard));
    EXPECT_TRUE(is_new("bunny", 1, {.domain = DomainKind::wide}));
    EXPECT_TRUE(is_new("bunny", 1, {.divisions = 7}));
    EXPECT_TRUE(is_new("bunny", 1, {.switches = "pq"}));
    EXPECT_TRUE(is_new("bunny", 1, {.repair = false}));
    EXPECT_TRUE(is_new("bunny", 1, {.tets = TetsKind::rays}));
    EXPECT_TRUE(is_new("bunny", 1, {.tets = TetsKind::rays, .effort = 3}));
    // Limits decide whether there is a scene, not which; the resolution is that of `cubes`, which is not cached.
    EXPECT_FALSE(is_new("bunny", 1, {.resolution = 3, .time_limit_s = 1, .memory_limit_bytes = 1}));
}

TEST_F(Cache, keeps_labels_from_leaving_its_folder)
{
    const fs::path path = cached_scene_path("../x y/\n", 1, {});
    EXPECT_EQ(path.parent_path(), cache);
    EXPECT_TRUE(path.filename().string().starts_with(".._x_y__-")) << path;
}

TEST_F(Cache, is_empty_without_a_folder)
{
    EXPECT_TRUE(list_cache().empty());
    EXPECT_EQ(clear_cache(), 0u);
    EXPECT_FALSE(fs::exists(folder / "xdg"));
}

TEST_F(Cache, lists_scenes_meshes_and_leftovers_with_their_sizes)
{
    write_file(cache / ("bunny" + key), "12345");
    write_file(cache / ("bunny" + key + ".4194305-0.tmp") / "scene.tet", "123");
    write_file(cached_mesh_path("bunny00.off", 7), "12");
    write_file(cache / "notes.txt", "mine");
    EXPECT_EQ(listed(), (std::set<std::string>{"bunny" + key, "bunny" + key + ".4194305-0.tmp",
                                               "meshes/0000000000000007/bunny00.off"}));
    std::uint64_t bytes = 0;
    for (const CachedFile& file : list_cache())
        bytes += file.bytes;
    EXPECT_EQ(bytes, 10u);
}

TEST_F(Cache, clears_what_is_its_own_and_nothing_else)
{
    write_file(cache / ("a.tet-b" + key), "12345");
    write_file(cache / ("bunny" + key + ".lock"), "");
    write_file(cache / ("bunny" + key + ".4194305-0.tmp") / "scene.tet", "123");
    write_file(cached_mesh_path("bunny00.off", 7), "12");
    write_file(cached_mesh_path("bunny00.off.4194305-0.tmp", 8), "1");
    const std::set<fs::path> foreign = {cache / "notes.txt",
                                        cache / "bunny.tet",
                                        cache / "bunny-0123.tet",
                                        cache / "meshes" / "my.off",
                                        cache / ("bunny" + key + ".bak"),
                                        cache / key,
                                        cache / "bunny-0123456789ABCDEF.tet",
                                        cache / ("bunny" + key + ".x.1-2.tmp"),
                                        cache / ("bunny" + key + ".1-.tmp"),
                                        cache / ("bunny" + key + ".-2.tmp"),
                                        cache / ("bunny" + key + ".1-x.tmp"),
                                        cache / ("a b" + key),
                                        folder / "xdg" / "other" / ("bunny" + key)};
    for (const fs::path& path : foreign)
        write_file(path, "mine");
    EXPECT_EQ(clear_cache(), 11u);
    EXPECT_TRUE(list_cache().empty());
    for (const fs::path& path : foreign)
        EXPECT_EQ(read_text(path), "mine") << path;
    EXPECT_FALSE(fs::exists(cache / ("bunny" + key + ".lock")));
    EXPECT_FALSE(fs::exists(cache / "meshes" / "0000000000000007"));
}

TEST_F(Cache, lists_and_clears_compiled_programs)
{
    const fs::path programs = cache / "programs";
    const std::string name = "0123456789abcdef.bin";
    write_file(programs / name, "12345");
    write_file(programs / (name + ".4194305-0.tmp"), "123");
    const std::set<fs::path> foreign = {programs / "my.bin", programs / "0123456789abcdef.txt",
                                        programs / (name + ".bak"), programs / ("x" + name), cache / name};
    for (const fs::path& path : foreign)
        write_file(path, "mine");
    EXPECT_EQ(listed(), (std::set<std::string>{"programs/" + name, "programs/" + name + ".4194305-0.tmp"}));
    EXPECT_EQ(clear_cache(), 8u);
    for (const fs::path& path : foreign)
        EXPECT_EQ(read_text(path), "mine") << path;
    for (const fs::path& path : foreign)
        fs::remove(path);
    EXPECT_EQ(clear_cache(), 0u);
    EXPECT_FALSE(fs::exists(programs)) << "an empty folder goes too";
}

TEST_F(Cache, spares_a_program_that_a_living_process_writes)
{
    const fs::path path = cache / "programs" / ("0123456789abcdef.bin." + std::to_string(::getpid()) + "-0.tmp");
    write_file(path, "12345");
    EXPECT_EQ(clear_cache(), 0u);
    EXPECT_TRUE(fs::exists(path));
}

TEST_F(Cache, removes_its_folder_with_its_last_file)
{
    write_file(cache / ("bunny" + key), "12345");
    (void)clear_cache();
    EXPECT_FALSE(fs::exists(cache));
}

TEST_F(Cache, follows_no_link_out_of_its_folder)
{
    write_file(folder / "elsewhere" / "precious", "mine");
    fs::create_directories(cache);
    fs::create_directory_symlink(folder / "elsewhere", cache / ("bunny" + key + ".4194305-0.tmp"));
    (void)clear_cache();
    EXPECT_EQ(read_text(folder / "elsewhere" / "precious"), "mine");
}

TEST_F(Cache, spares_a_build_that_is_going_on)
{
    const fs::path work = cache / ("bunny" + key + ".4194305-0.tmp"), lock_path = cache / ("bunny" + key + ".lock");
    write_file(work / "scene.tet", "123");
    {
        const auto lock = FileLock::try_take(lock_path);
        ASSERT_TRUE(lock);
        EXPECT_EQ(clear_cache(), 0u);
        EXPECT_TRUE(fs::exists(work / "scene.tet"));
        EXPECT_TRUE(fs::exists(lock_path));
    }
    EXPECT_EQ(clear_cache(), 3u);
    EXPECT_FALSE(fs::exists(work));
}

TEST_F(Cache, says_which_folder_cannot_be_made)
{
    write_file(folder / "xdg", "a file where the folder should be");
    EXPECT_TRUE(contains(error_of([&] { (void)cached_mesh_path("x.off", 1); }),
                         "invalid_input: making the cache's folder " + cache.string()));
}

TEST_F(Cache, lock_is_exclusive_and_leaves_no_file)
{
    const fs::path path = folder / "lock";
    {
        const auto lock = FileLock::try_take(path);
        ASSERT_TRUE(lock);
        EXPECT_FALSE(FileLock::try_take(path));
    }
    EXPECT_FALSE(fs::exists(path));
    EXPECT_TRUE(FileLock::try_take(path));
}

TEST_F(Cache, lock_ends_with_its_process)
{
    const fs::path path = folder / "lock";
    const pid_t owner = ::fork();
    ASSERT_GE(owner, 0);
    if (owner == 0) {
        const auto lock = FileLock::try_take(path);
        write_file(folder / "taken", lock ? "yes" : "no");
        for (;;)
            ::pause();
    }
    while (read_text(folder / "taken").empty())
        ::usleep(1000);
    EXPECT_FALSE(FileLock::try_take(path));
    ::kill(owner, SIGKILL);
    ::waitpid(owner, nullptr, 0);
    EXPECT_TRUE(fs::exists(path)); // nobody was there to remove it, and that is not a hindrance
    EXPECT_TRUE(FileLock::try_take(path));
}

TEST_F(Cache, atomic_file_appears_whole_or_not_at_all)
{
    const std::string before = "before", after = "after";
    write_file(folder / "file", before);
    {
        AtomicFile file(folder / "file");
        file.write(std::as_bytes(std::span(after)));
        EXPECT_EQ(read_text(folder / "file"), before);
    }
    EXPECT_EQ(read_text(folder / "file"), before);
    AtomicFile file(folder / "file");
    file.write(std::as_bytes(std::span(after)));
    file.commit();
    EXPECT_EQ(read_text(folder / "file"), after);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}
