// A scene is built once, however often and by however many processes it is asked for, unless the cache's file is
// unusable.
#include "tests/scenes/load_fixture.h"

#include <csignal>
#include <cstdio>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

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
    other.build.switches = "pq9";
    write_scene(cached(), other);
    EXPECT_TRUE(contains(load().messages.at(0), "made with the switches pq9, not pq5Y"));
    EXPECT_EQ(builder_runs(), 3u);
    EXPECT_TRUE(load().from_cache);
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
    const LoadedScene loaded = load_scene(request, [&](const std::string& stage, auto...) {
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
    EXPECT_EQ(list_cache().size(), 1u) << "the files of the killed one are gone";
    (void)clear_cache();
    EXPECT_TRUE(cache_is_clean());
}
