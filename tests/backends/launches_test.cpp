// How jobs are cut into launches: of which tiles, how many at a time, with which parameters and outputs.
#include "core/device/launch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

TEST(Launches, cover_each_tile_of_the_jobs_once_and_in_order)
{
    Launches launches(8, 100);
    const std::vector<LaunchParams> images = {params_of(300, 200), params_of(8, 8), params_of(100, 70)};
    std::vector<std::uint32_t> next_tile(images.size());
    std::size_t job = 0;
    const auto enqueue = [&](std::span<const LaunchPiece> pieces, std::uint32_t passes) {
        EXPECT_EQ(passes, 1u);
        for (const LaunchPiece& piece : pieces) {
            EXPECT_GE(piece.job, job);
            job = piece.job;
            EXPECT_EQ(piece.params.width, images[job].width);
            EXPECT_EQ(piece.params.first_tile, next_tile[job]);
            EXPECT_LE(piece.tiles, 100u) << "the API's limit";
            next_tile[job] += piece.tiles;
        }
        launches.took(tile_count(pieces), passes, 1e-3);
    };
    launches.start(images, 1, enqueue, [] {});
    for (std::size_t i = 0; i < images.size(); ++i)
        EXPECT_EQ(next_tile[i], tile_count(images[i]));
}

TEST(Launches, are_full_of_several_jobs_and_few)
{
    Launches launches(8);
    const std::vector<LaunchParams> images(5, params_of(240, 240)); // of 900 tiles
    const auto sizes_of = [&](double tile_s) {
        std::vector<std::uint32_t> sizes;
        launches.start(
            images, 1, [&](std::span<const LaunchPiece> pieces, std::uint32_t) { sizes.push_back(tile_count(pieces)); },
            [] {});
        for (const std::uint32_t tiles : sizes)
            launches.took(tiles, 1, tiles * tile_s);
        return sizes;
    };
    (void)sizes_of(1e-4);
    EXPECT_EQ(sizes_of(1e-4), (std::vector<std::uint32_t>{1000, 1000, 1000, 1000, 500})) << "a tenth of a second each";
    (void)sizes_of(1e-6);
    (void)sizes_of(1e-6);
    EXPECT_EQ(sizes_of(1e-6), (std::vector<std::uint32_t>{4500})) << "all jobs together";
}

TEST(Launches, of_many_short_passes_soon_have_as_many_together_as_take_a_second)
{
    Launches launches(8);
    const std::vector images = {params_of(300, 200)};
    const std::uint32_t all = tile_count(images[0]);
    std::uint32_t passes_in_all = 0, most = 0;
    const auto enqueue = [&](std::span<const LaunchPiece> pieces, std::uint32_t passes) {
        const std::uint32_t tiles = tile_count(pieces);
        passes_in_all += tiles == all ? passes : 0;
        most = std::max(most, passes);
        launches.took(tiles, passes, 1e-5 * passes * tiles / all);
    };
    launches.start(images, 1, enqueue, [] {});
    passes_in_all = 0;
    launches.start(images, 4000, enqueue, [] {});
    EXPECT_EQ(passes_in_all, 4000u);
    EXPECT_GT(most, 1000u) << "of 10 us each";
}

TEST(Launches, ask_for_times_after_each_of_the_first_pass_only)
{
    Launches launches(8);
    const std::vector images = {params_of(300, 200), params_of(200, 200)};
    for (const bool is_first : {true, false}) {
        int enqueued = 0, asked = 0;
        launches.start(
            images, 1, [&](std::span<const LaunchPiece>, std::uint32_t) { ++enqueued; }, [&] { ++asked; });
        EXPECT_GT(enqueued, 1);
        EXPECT_EQ(asked, is_first ? enqueued : 0);
    }
}

TEST(Launches, add_up_the_seconds_of_one_start)
{
    Launches launches(8);
    const std::vector images = {params_of(80, 80)}; // one launch
    for (const double seconds : {3.0, 0.5}) {
        launches.start(
            images, 1, [](std::span<const LaunchPiece>, std::uint32_t) {}, [] {});
        EXPECT_EQ(launches.seconds(), 0);
        launches.took(60, 1, seconds);
        launches.took(40, 1, 1.0);
        EXPECT_EQ(launches.seconds(), seconds + 1.0);
    }
}

TEST(Launches, are_sized_by_the_times_that_were_reported)
{
    Launches launches(8);
    std::vector<std::uint32_t> sizes;
    launches.start(
        std::array{params_of(2000, 2000)}, 1,
        [&](std::span<const LaunchPiece> pieces, std::uint32_t) { sizes.push_back(tile_count(pieces)); },
        [&] { launches.took(sizes.back(), 1, sizes.back() * 1e-3); }); // a tenth of a second: a hundred tiles
    ASSERT_GT(sizes.size(), 3u);
    EXPECT_NEAR(sizes[1], 100, 1);
    EXPECT_NEAR(sizes[2], 100, 1);
}

TEST(Launches, of_jobs_that_fit_in_one_have_all_their_passes)
{
    Launches launches(8);
    const std::vector small = {params_of(64, 32), params_of(32, 64)}, large = {params_of(2000, 2000)};
    std::vector<std::uint32_t> passes;
    const auto enqueue = [&](std::span<const LaunchPiece> pieces, std::uint32_t count) {
        passes.push_back(count);
        launches.took(tile_count(pieces), count, 1e-3 * tile_count(pieces) * count); // a tenth of a second: 100 tiles
    };
    launches.start(small, 3, enqueue, [] {});
    EXPECT_EQ(passes, (std::vector<std::uint32_t>{1, 2})) << "how long a launch takes is not known before the first";
    EXPECT_DOUBLE_EQ(launches.seconds(), 3 * 64e-3);
    passes.clear();
    launches.start(large, 2, enqueue, [] {});
    EXPECT_GT(passes.size(), 2 * tile_count(large[0]) / 400);
    EXPECT_EQ(std::ranges::count(passes, 1u), static_cast<std::ptrdiff_t>(passes.size()));
}

namespace {

/// The part of the output that each piece writes, for each pass in turn, as enqueue gets it.
std::vector<std::vector<std::size_t>> parts_of_passes(Launches& launches, std::span<const LaunchParams> images,
                                                      std::uint32_t passes, std::uint32_t in_flight)
{
    std::vector<std::vector<std::size_t>> parts;
    launches.start(
        images, passes,
        [&](std::span<const LaunchPiece> pieces, std::uint32_t count) {
            for (std::uint32_t pass = 0; pass < count; ++pass) {
                parts.emplace_back();
                for (const LaunchPiece& piece : launches.of_pass(pieces, pass))
                    parts.back().push_back(piece.job);
            }
            launches.took(tile_count(pieces), count, 1e-4 * count); // a thousandth of the limit
        },
        [] {}, in_flight);
    return parts;
}

} // namespace

TEST(Launches, in_flight_together_write_to_their_outputs_in_turn)
{
    Launches launches(8);
    const std::vector images = {params_of(64, 32), params_of(32, 64)};
    using Parts = std::vector<std::vector<std::size_t>>;
    EXPECT_EQ(parts_of_passes(launches, images, 1, 2), (Parts{{0, 1}}));
    EXPECT_EQ(parts_of_passes(launches, images, 3, 2), (Parts{{0, 1}, {2, 3}, {0, 1}}));
    EXPECT_EQ(parts_of_passes(launches, images, 3, 1), (Parts{{0, 1}, {0, 1}, {0, 1}}));
}

TEST(Launches, in_flight_together_are_one_in_a_sessions_first_pass)
{
    Launches launches(8);
    const std::vector images = {params_of(64, 32), params_of(32, 64)};
    using Parts = std::vector<std::vector<std::size_t>>;
    EXPECT_EQ(parts_of_passes(launches, images, 4, 3), (Parts{{0, 1, 2, 3, 4, 5}, {0, 1}}));
}

TEST(Launches, in_flight_together_hold_the_end_of_a_pass_and_more_of_the_next_if_one_does_not_fit)
{
    Launches launches(8);
    const std::vector images = {params_of(240, 240)}; // of 900 tiles
    const auto sizes_of = [&](std::uint32_t passes, std::uint32_t in_flight) {
        std::vector<std::uint32_t> sizes;
        std::vector<std::uint32_t> tiles(in_flight);
        launches.start(
            images, passes,
            [&](std::span<const LaunchPiece> pieces, std::uint32_t count) {
                EXPECT_EQ(count, 1u);
                for (const LaunchPiece& piece : launches.of_pass(pieces, 0))
                    tiles.at(piece.job) += piece.tiles;
                sizes.push_back(tile_count(pieces));
                launches.took(sizes.back(), 1, sizes.back() * (0.1 / 500.5)); // 500 tiles are a launch
            },
            [] {}, in_flight);
        EXPECT_EQ(tiles.front(), 900 * (passes + in_flight - 1) / in_flight);
        EXPECT_EQ(tiles.back(), 900 * (passes / in_flight));
        return sizes;
    };
    (void)sizes_of(1, 1);
    EXPECT_EQ(sizes_of(2, 1), (std::vector<std::uint32_t>{500, 400, 500, 400}));
    EXPECT_EQ(sizes_of(3, 2), (std::vector<std::uint32_t>{500, 500, 500, 300, 500, 400}));
}

TEST(OutputParts, of_one_job_are_its_results_between_guards)
{
    const OutputParts parts(std::array<std::size_t, 1>{17 * 9}, HIT_WORDS);
    EXPECT_EQ(parts.words(), 2 * GUARD_WORDS + HIT_WORDS * 17 * 9);
    EXPECT_EQ(OutputParts(std::array<std::size_t, 1>{17 * 9}, 1).words(), 2 * GUARD_WORDS + 17 * 9);
    EXPECT_EQ(OutputParts().words(), 0u);
}

TEST(OutputParts, of_several_jobs_are_aligned_and_apart)
{
    const OutputParts parts(std::array<std::size_t, 3>{153, 0, 8}, HIT_WORDS);
    ASSERT_EQ(parts.count(), 3u);
    std::vector<std::uint32_t> output(parts.words());
    for (std::size_t job = 0; job < 3; ++job) {
        EXPECT_EQ(parts.begin(job) * sizeof(std::uint32_t) % 4096, 0u);
        EXPECT_GE(parts.begin(job), job == 0 ? 0 : parts.begin(job - 1) + parts.size(job - 1));
        const auto results = parts.results(std::span(output), job);
        EXPECT_EQ(results.data() - output.data(), static_cast<std::ptrdiff_t>(parts.begin(job) + GUARD_WORDS));
        EXPECT_EQ(results.size(), HIT_WORDS * (job == 0 ? 153 : job == 1 ? 0 : 8));
    }
    EXPECT_EQ(parts.begin(2) + parts.size(2), parts.words());
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
}
