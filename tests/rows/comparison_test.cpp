#include "bench/measuring/comparison.h"

#include "tests/support/row_runs.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

RowRecord row_on(const std::string& backend, DeviceKind kind, double seconds, const std::string& uuid = "")
{
    RowRecord row;
    row.key = {"bunny", backend, {}, RayKind::primary, TetOrder::chains, 0};
    row.device.kind = kind;
    row.device.uuid = uuid;
    Traced result;
    result.totals.rays = 1000;
    row.outcome = result;
    row.samples_s = {0.99 * seconds, seconds, 1.01 * seconds, seconds, 0.99 * seconds, 1.01 * seconds};
    return row;
}

} // namespace

TEST(Comparison, emulations_compare_with_openmp_and_gpus_with_cuda)
{
    const auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("opencl", DeviceKind::emulated, 4),
                           row_on("vulkan", DeviceKind::gpu, 1, "a"), row_on("cuda", DeviceKind::gpu, 0.5, "a"));
    const auto found = compare_rows(rows);
    EXPECT_FALSE(found[0].has_value()) << "the reference itself";
    ASSERT_TRUE(found[1].has_value());
    EXPECT_EQ(found[1]->reference, &rows[0]);
    EXPECT_DOUBLE_EQ(found[1]->ratio, 0.5) << "above 1 is faster";
    EXPECT_TRUE(found[1]->interval.value().contains(0.5));
    ASSERT_TRUE(found[2].has_value());
    EXPECT_EQ(found[2]->reference, &rows[3]);
    EXPECT_FALSE(found[3].has_value());
}

TEST(Comparison, is_of_rows_with_as_many_launches_in_flight)
{
    auto rows = list(row_on("cuda", DeviceKind::gpu, 2, "a"), row_on("vulkan", DeviceKind::gpu, 1, "a"),
                     row_on("cuda", DeviceKind::gpu, 4, "a"));
    rows[1].key.in_flight = rows[2].key.in_flight = 2;
    for (RowRecord& row : rows)
        row.device.name = "a GPU";
    EXPECT_EQ(compare_rows(rows)[1]->reference, &rows[2]);
    EXPECT_EQ(contests_of(rows).size(), 2u);
    rows[2].key.in_flight = 3;
    EXPECT_FALSE(compare_rows(rows)[2].has_value());
    EXPECT_EQ(contests_of(rows).size(), 3u);
}

TEST(Comparison, of_fewer_than_five_samples_has_no_interval)
{
    auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("opencl", DeviceKind::emulated, 4));
    rows[1].samples_s.resize(5);
    EXPECT_TRUE(compare_rows(rows)[1]->interval.has_value());
    rows[1].samples_s.resize(4);
    EXPECT_FALSE(compare_rows(rows)[1]->interval.has_value());
    EXPECT_NEAR(compare_rows(rows)[1]->ratio, 0.5, 0.01);
}

TEST(Comparison, of_several_runs_has_an_interval_over_them)
{
    auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("opencl", DeviceKind::emulated, 4));
    const std::vector<double> run = rows[1].samples_s;
    for (const double factor : {1.0, 1.25, 1.0})
        for (RowRecord& row : rows) {
            if (row.run_samples.empty()) row.samples_s.clear();
            for (const double seconds : run)
                row.samples_s.push_back(&row == &rows[0] ? seconds / 2 : seconds * factor);
            row.run_samples.push_back(run.size());
        }
    const auto found = compare_rows(rows)[1];
    EXPECT_EQ(found->runs, 3u);
    EXPECT_NEAR(found->interval->low, 0.4, 1e-9);
    EXPECT_NEAR(found->interval->high, 0.5, 1e-9);
    EXPECT_EQ(interval_text(*found), "[0.40, 0.50]");
    rows[0].run_samples = {18};
    EXPECT_EQ(compare_rows(rows)[1]->runs, 1u) << "the reference lacks such runs";
}

TEST(Comparison, without_cuda_a_gpus_first_api_is_the_reference)
{
    const auto rows = list(row_on("opencl", DeviceKind::gpu, 2, "a"), row_on("vulkan", DeviceKind::gpu, 1, "a"));
    const auto found = compare_rows(rows);
    EXPECT_FALSE(found[0].has_value());
    ASSERT_TRUE(found[1].has_value());
    EXPECT_EQ(found[1]->reference, &rows[0]);
}

TEST(Comparison, an_emulation_without_openmp_has_no_ratio)
{
    for (const auto& found :
         compare_rows(list(row_on("opencl", DeviceKind::emulated, 2), row_on("vulkan", DeviceKind::emulated, 1))))
        EXPECT_FALSE(found.has_value());
}

TEST(Comparison, no_ratio_joins_host_and_gpu_or_two_gpus)
{
    for (const auto& found :
         compare_rows(list(row_on("openmp", DeviceKind::cpu, 2), row_on("cuda", DeviceKind::gpu, 1, "a"),
                           row_on("vulkan", DeviceKind::gpu, 1, "b"))))
        EXPECT_FALSE(found.has_value());
}

TEST(Comparison, only_the_same_kernel_on_the_same_scene_compares)
{
    auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("opencl", DeviceKind::emulated, 2),
                     row_on("opencl", DeviceKind::emulated, 2), row_on("opencl", DeviceKind::emulated, 2),
                     row_on("opencl", DeviceKind::emulated, 2));
    rows[1].key.scene = "armadillo";
    rows[2].key.kernel.layout = Layout::tet96;
    rows[3].key.kernel.math = MathMode::fast;
    rows[4].key.kernel.schedule = Schedule::persistent;
    const auto found = compare_rows(rows);
    for (const std::size_t i : {1u, 2u, 3u})
        EXPECT_FALSE(found[i].has_value()) << i;
    ASSERT_TRUE(found[4].has_value()) << "the reference has tiles";
    EXPECT_EQ(found[4]->reference, &rows[0]);
}

TEST(Comparison, rows_of_each_ray_order_compare_with_openmps_of_that_order)
{
    auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("openmp", DeviceKind::cpu, 3),
                     row_on("vulkan", DeviceKind::emulated, 4), row_on("vulkan", DeviceKind::emulated, 5));
    rows[1].key.ray_order = rows[3].key.ray_order = RayOrder::morton;
    const auto found = compare_rows(rows);
    ASSERT_TRUE(found[2].has_value() && found[3].has_value());
    EXPECT_EQ(found[2]->reference, &rows[0]);
    EXPECT_EQ(found[3]->reference, &rows[1]);
}

TEST(Comparison, a_row_without_a_rate_neither_compares_nor_is_a_reference)
{
    auto rows = list(row_on("openmp", DeviceKind::cpu, 2), row_on("opencl", DeviceKind::emulated, 2));
    std::get<Traced>(rows[0].outcome).different = 1;
    EXPECT_FALSE(compare_rows(rows)[1].has_value());
    std::get<Traced>(rows[0].outcome).different = 0;
    EXPECT_TRUE(compare_rows(rows)[1].has_value());
    rows[1].outcome = Failed{ErrorKind::internal, "device lost"};
    EXPECT_FALSE(compare_rows(rows)[1].has_value());
}
