#include "core/device/team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <vector>

namespace tetrace {

TEST(Team, calls_each_tile_of_each_job_and_pass_once)
{
    constexpr std::uint32_t passes = 600, jobs = 3; // more passes than have a common end
    constexpr std::array<std::uint32_t, jobs> tiles = {1, 7, 64};
    for (const unsigned threads : {1u, 2u, 5u}) {
        std::array<std::vector<std::atomic<std::uint32_t>>, jobs> calls{
            std::vector<std::atomic<std::uint32_t>>(tiles[0]), std::vector<std::atomic<std::uint32_t>>(tiles[1]),
            std::vector<std::atomic<std::uint32_t>>(tiles[2])};
        on_team(threads, passes, jobs, [&](std::size_t job, SharedTiles& shared) {
            shared.take(tiles.at(job), 4, [&](std::uint32_t tile) { ++calls.at(job)[tile]; });
        });
        for (const auto& job : calls)
            for (const auto& count : job)
                EXPECT_EQ(count.load(), passes) << threads << " threads";
    }
}

// At a barrier between the jobs it would wait for ever: the first job's tile ends after the second job's have.
TEST(Team, a_thread_that_finds_no_tile_left_goes_on_with_the_next_job)
{
    std::atomic<int> threads{0};
    on_team(2, 1, 1, [&](std::size_t, SharedTiles&) { ++threads; });
    if (threads < 2) GTEST_SKIP() << "OpenMP gives one thread here";
    std::atomic<std::uint32_t> second{0};
    on_team(2, 1, 2, [&](std::size_t job, SharedTiles& shared) {
        if (job == 0)
            shared.take(1, 1, [&](std::uint32_t) { second.wait(0); });
        else
            shared.take(8, 1, [&](std::uint32_t) {
                ++second;
                second.notify_all();
            });
    });
    EXPECT_EQ(second.load(), 8u);
}

TEST(Team, a_pass_begins_when_the_one_before_it_has_ended_of_all_jobs)
{
    constexpr std::uint32_t passes = 200, tiles = 16, jobs = 2;
    for (const unsigned threads : {2u, 5u}) {
        // Not atomic: ThreadSanitizer would see passes that overlap, too.
        std::vector<std::uint32_t> output(std::size_t{jobs} * tiles, 0);
        std::vector<std::atomic<std::uint32_t>> ended(passes);
        std::atomic<bool> overlapped{false};
        on_team(threads, passes, jobs, [&](std::size_t job, SharedTiles& shared) {
            shared.take(tiles, 1, [&](std::uint32_t tile) {
                const std::uint32_t pass = output[job * tiles + tile]++;
                if (pass > 0 && ended[pass - 1] != jobs * tiles) overlapped = true;
                ++ended[pass];
            });
        });
        EXPECT_FALSE(overlapped.load()) << threads << " threads";
        EXPECT_EQ(output, std::vector<std::uint32_t>(output.size(), passes));
    }
}

TEST(Team, shares_what_threads_count_by_themselves)
{
    constexpr std::uint32_t items = 1000, passes = 50;
    for (const unsigned threads : {1u, 2u, 5u}) {
        std::vector<std::uint32_t> calls(items, 0); // not atomic, as above
        on_team(threads, passes, 1, [&](std::size_t, SharedTiles& shared) {
            shared.share([&](std::uint32_t* next) {
                for (std::uint32_t item; (item = std::atomic_ref(*next).fetch_add(1)) < items;)
                    ++calls[item];
            });
        });
        EXPECT_EQ(calls, std::vector<std::uint32_t>(items, passes)) << threads << " threads";
    }
}

} // namespace tetrace
