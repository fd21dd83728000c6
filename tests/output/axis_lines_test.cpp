// Rates along sizes of images and numbers of threads.
#include "bench/output/axis_lines.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

/// A row of one view, whose launch takes 1 ms and whose million rays take 100 ms.
RowRecord row_at(const std::string& scene, std::uint64_t rays, double noise = 0)
{
    RowRecord row;
    row.key.scene = scene;
    row.key.backend = "openmp";
    row.device.name = "CPU";
    Traced result;
    result.totals.rays = rays;
    row.outcome = result;
    row.launches = {1, 1};
    const double seconds = 1e-3 + 1e-7 * static_cast<double>(rays);
    for (const double part : {-1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0})
        row.samples_s.push_back(seconds * (1 + noise * part));
    return row;
}

BenchResult sized_run(double noise)
{
    BenchResult result;
    for (const unsigned side : {100u, 1000u, 200u}) {
        const std::string name = "bunny/size:" + std::to_string(side);
        result.scenes.push_back({{"name", name}, {"width", side}, {"height", side}});
        result.rows.push_back(row_at(name, std::uint64_t{side} * side, noise));
    }
    return result;
}

std::vector<std::string> titles_of(const Table& table)
{
    std::vector<std::string> titles;
    for (const Column& column : table.columns())
        titles.push_back(column.title);
    return titles;
}

} // namespace

TEST(AxisLines, of_sizes_say_what_a_launch_and_a_million_rays_cost)
{
    const Table table = size_table(size_lines(sized_run(0)));
    EXPECT_EQ(titles_of(table), (std::vector<std::string>{"row", "backend", "100x100", "200x200", "1000x1000",
                                                          "a launch", "a million rays"}));
    ASSERT_EQ(table.rows().size(), 1u);
    const auto& cells = table.rows().front();
    EXPECT_NEAR(std::get<double>(cells[2]), 0.01 / 0.002, 1e-9);
    EXPECT_NEAR(std::get<double>(cells[4]), 1 / 0.101, 1e-9);
    EXPECT_NEAR(std::get<double>(cells[5]), 1000, 1e-6) << "us";
    EXPECT_NEAR(std::get<double>(cells[6]), 100, 1e-6) << "ms";
}

TEST(AxisLines, of_images_with_equally_many_rays_show_no_cost_of_launches)
{
    BenchResult result;
    for (const auto& [width, height] : {std::pair(512u, 128u), std::pair(256u, 256u)}) {
        const std::string name = "bunny/size:" + std::to_string(width);
        result.scenes.push_back({{"name", name}, {"width", width}, {"height", height}});
        result.rows.push_back(row_at(name, 65536));
    }
    const Table table = size_table(size_lines(result));
    EXPECT_EQ(table.columns().size(), 6u) << "both sizes";
    const auto& cells = table.rows().front();
    EXPECT_TRUE(is_empty(cells[4]));
    EXPECT_NEAR(std::get<double>(cells[5]), 1e3 * (1e-3 + 65536e-7) / 65536e-6, 1e-6) << "ms, all of it";
}

TEST(AxisLines, leave_out_a_cost_of_launches_that_noise_explains)
{
    const Table table = size_table(size_lines(sized_run(0.9)));
    const auto& cells = table.rows().front();
    EXPECT_TRUE(is_empty(cells[5]));
    EXPECT_NEAR(std::get<double>(cells[6]), 101, 3) << "of the largest";
}

TEST(AxisLines, of_threads_say_how_near_they_come_to_the_ideal)
{
    BenchResult result;
    result.threads = 4;
    for (const unsigned threads : {1u, 0u}) {
        result.rows.push_back(row_at("bunny", 1'000'000));
        result.rows.back().key.threads = threads;
        for (double& seconds : result.rows.back().samples_s)
            seconds /= threads == 0 ? 3 : 1;
    }
    const Table table = thread_table(thread_lines(result));
    EXPECT_EQ(titles_of(table), (std::vector<std::string>{"row", "backend", "1 thread", "4 threads", "of ideal"}));
    EXPECT_NEAR(std::get<double>(table.rows().front()[4]), 75, 1e-6) << "%";
}

TEST(AxisLines, are_none_of_one_size_and_one_number)
{
    BenchResult result;
    result.threads = 2;
    result.scenes.push_back({{"name", "bunny"}, {"width", 100}, {"height", 100}});
    result.rows.push_back(row_at("bunny", 10'000));
    EXPECT_TRUE(size_lines(result).empty());
    EXPECT_TRUE(thread_lines(result).empty());
}
