#include "core/device/team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <mutex>
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
    std::atomic<std::uint32_t> second{0};
    on_team(2, 1, 2, [&](std::size_t job, SharedTiles& shared) {
        if (job == 0) shared.take(1, 1, [&](std::uint32_t) { second.wait(0); });
        if (job == 1)
            shared.take(8, 1, [&](std::uint32_t) {
                ++second;
                second.notify_all();
            });
    });
    EXPECT_EQ(second.load(), 8u);
}

TEST(Team, passes_of_a_job_do_not_overlap)
{
    constexpr std::uint32_t passes = 200, tiles = 16;
    std::vector<std::uint32_t> output(tiles, 0); // not atomic: a thread checker sees passes that overlap
    std::atomic<bool> overlapped{false};
    std::vector<std::uint32_t> left(passes, tiles);
    std::mutex mutex;
    on_team(3, passes, 1, [&](std::size_t, SharedTiles& shared) {
        shared.take(tiles, 1, [&](std::uint32_t tile) {
            const std::uint32_t pass = output[tile]++;
            const std::lock_guard lock(mutex);
            if (pass > 0 && left[pass - 1] > 0) overlapped = true;
            --left[pass];
        });
    });
    EXPECT_FALSE(overlapped.load());
    EXPECT_EQ(output, std::vector<std::uint32_t>(tiles, passes));
}

TEST(Team, shares_what_threads_count_by_themselves)
{
    constexpr std::uint32_t items = 1000;
    std::vector<std::atomic<std::uint32_t>> calls(items);
    on_team(1, 3, 1, [&](std::size_t, SharedTiles& shared) {
        shared.share(1, [&](std::uint32_t* next) {
            for (std::uint32_t item; (item = std::atomic_ref(*next).fetch_add(1)) < items;)
                ++calls[item];
        });
    });
    for (const auto& count : calls)
        EXPECT_EQ(count.load(), 3u);
}

} // namespace tetrace
