// How an image is cut into launches: of which tiles, how many at a time, and what its launches are told.
#include "core/device/launch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace tetrace;

namespace {

LaunchParams params_of(std::uint32_t width, std::uint32_t height)
{
    TraceJob job;
    job.width = width;
    job.height = height;
    return launch_params(job, {.divisions = 8, .low = {}, .high = {}}, 8, 31);
}

} // namespace

TEST(LaunchSize, starts_small_grows_by_steps_and_shrinks_at_once)
{
    LaunchSize size(8);
    const std::uint32_t first = size.tiles();
    EXPECT_LE(first * 64, 16'384u);
    size.took(first, 1e-4);
    EXPECT_EQ(size.tiles(), 4 * first);
    size.took(4 * first, 10.0); // a hundred times the target
    EXPECT_NEAR(size.tiles(), 4 * first / 100.0, 1.0);
    size.took(1, 100.0);
    EXPECT_EQ(size.tiles(), 1u) << "a launch has a tile at least";
}

TEST(LaunchSize, a_steady_device_gets_a_tenth_of_a_second)
{
    LaunchSize size(4);
    constexpr double tiles_per_s = 1e5;
    for (int i = 0; i < 20; ++i)
        size.took(size.tiles(), size.tiles() / tiles_per_s);
    EXPECT_NEAR(size.tiles() / tiles_per_s, 0.1, 0.01);
}

TEST(LaunchSize, the_short_last_launch_of_an_image_does_not_shrink_the_next)
{
    LaunchSize size(8);
    for (int i = 0; i < 20; ++i)
        size.took(size.tiles(), size.tiles() * 1e-5);
    const std::uint32_t steady = size.tiles();
    size.took(3, 3e-5);
    EXPECT_GE(size.tiles(), steady * 9 / 10);
}

TEST(LaunchSize, stays_within_the_apis_limit)
{
    LaunchSize size(8, 100);
    EXPECT_EQ(size.tiles(), 100u);
    size.took(100, 1e-6);
    EXPECT_EQ(size.tiles(), 100u);
}

TEST(Launches, cover_each_tile_of_an_image_once_and_in_order)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(300, 200);
    std::uint32_t next_tile = 0;
    const auto enqueue = [&](const LaunchParams& params, std::uint32_t tiles, std::uint32_t passes) {
        EXPECT_EQ(passes, 1u);
        EXPECT_EQ(params.first_tile, next_tile);
        EXPECT_LE(tiles, 100u);
        next_tile += tiles;
        launches.took(tiles, passes, 1e-3);
    };
    launches.start(image, 1, enqueue, [] {});
    EXPECT_EQ(next_tile, tile_count(image));
}

TEST(Launches, of_many_short_passes_soon_have_as_many_together_as_take_a_second)
{
    Launches launches(8);
    const LaunchParams image = params_of(300, 200);
    std::uint32_t passes_in_all = 0, most = 0;
    const auto enqueue = [&](const LaunchParams&, std::uint32_t tiles, std::uint32_t passes) {
        passes_in_all += tiles == tile_count(image) ? passes : 0;
        most = std::max(most, passes);
        launches.took(tiles, passes, 1e-5 * passes * tiles / tile_count(image));
    };
    launches.start(image, 1, enqueue, [] {});
    passes_in_all = 0;
    launches.start(image, 4000, enqueue, [] {});
    EXPECT_EQ(passes_in_all, 4000u);
    EXPECT_GT(most, 1000u) << "of 10 us each";
}

TEST(Launches, ask_for_times_after_each_of_the_first_image_only)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(300, 200);
    for (const bool is_first : {true, false}) {
        int enqueued = 0, asked = 0;
        launches.start(
            image, 1, [&](const LaunchParams&, std::uint32_t, std::uint32_t) { ++enqueued; }, [&] { ++asked; });
        EXPECT_GT(enqueued, 1);
        EXPECT_EQ(asked, is_first ? enqueued : 0);
    }
}

TEST(Launches, add_up_the_seconds_of_one_image)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(80, 80); // one launch
    for (const double seconds : {3.0, 0.5}) {
        launches.start(
            image, 1, [](const LaunchParams&, std::uint32_t, std::uint32_t) {}, [] {});
        EXPECT_EQ(launches.seconds(), 0);
        launches.took(60, 1, seconds);
        launches.took(40, 1, 1.0);
        EXPECT_EQ(launches.seconds(), seconds + 1.0);
    }
}

TEST(Launches, are_sized_by_the_times_they_are_told)
{
    Launches launches(8);
    std::vector<std::uint32_t> sizes;
    launches.start(
        params_of(2000, 2000), 1,
        [&](const LaunchParams&, std::uint32_t tiles, std::uint32_t) { sizes.push_back(tiles); },
        [&] { launches.took(sizes.back(), 1, sizes.back() * 1e-3); }); // a tenth of a second: a hundred tiles
    ASSERT_GT(sizes.size(), 3u);
    EXPECT_NEAR(sizes[1], 100, 1);
    EXPECT_NEAR(sizes[2], 100, 1);
}

TEST(Launches, of_an_image_that_fits_in_one_have_all_its_passes)
{
    Launches launches(8);
    const LaunchParams small = params_of(64, 64), large = params_of(2000, 2000);
    std::vector<std::uint32_t> passes;
    const auto enqueue = [&](const LaunchParams&, std::uint32_t tiles, std::uint32_t count) {
        passes.push_back(count);
        launches.took(tiles, count, 1e-3 * tiles * count); // a tenth of a second: a hundred tiles
    };
    launches.start(small, 3, enqueue, [] {});
    EXPECT_EQ(passes, (std::vector<std::uint32_t>{1, 2})) << "how long a launch takes is not known before the first";
    EXPECT_DOUBLE_EQ(launches.seconds(), 3 * 64e-3);
    passes.clear();
    launches.start(large, 2, enqueue, [] {});
    EXPECT_GT(passes.size(), 2 * tile_count(large) / 400);
    EXPECT_EQ(std::ranges::count(passes, 1u), static_cast<std::ptrdiff_t>(passes.size()));
}

TEST(LaunchParams, carry_the_job_word_for_word)
{
    TraceJob job;
    job.view.step_y.z = 5;
    job.width = 17;
    job.height = 9;
    job.start_tet = 3;
    job.max_steps = 100;
    const LaunchParams params = launch_params(job, {.divisions = 6, .low = {-1, 0, 0}, .high = {0, 0, 2}}, 4, 20);
    EXPECT_EQ(params.step_y.z, 5);
    EXPECT_EQ(params.width, 17u);
    EXPECT_EQ(params.start_tet, 3u);
    EXPECT_EQ(params.divisions, 6u);
    EXPECT_EQ(params.domain_low, (Float3{-1, 0, 0}));
    EXPECT_EQ(params.domain_high, (Float3{0, 0, 2}));
    EXPECT_EQ(params.tile_height, 4u);
    EXPECT_EQ(params.part_log2, 20u);
    EXPECT_EQ(tile_count(params), 3u * 3u);
    EXPECT_EQ(output_words(job, Task::trace), 2 * GUARD_WORDS + HIT_WORDS * 17 * 9);
    EXPECT_EQ(output_words(job, Task::search), 2 * GUARD_WORDS + 17 * 9);
}
