#include "bench/measuring/row_devices.h"

#include "core/device/yardstick.h"
#include "tests/support/fake_backend.h"
#include "tests/support/row_runs.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Device device(const char* name, DeviceKind kind, const char* uuid = "")
{
    Device result;
    result.name = name;
    result.kind = kind;
    result.uuid = uuid;
    return result;
}

// Backends are static as every backend is: what is found out about a device is kept by its address.

/// A row of 1,000,000 steps in a millisecond: 44 GB/s in tet80.
RowRecord row_on(Backend& backend)
{
    RowRecord row;
    row.key = {"a", backend.name(), {}, RayKind::primary, TetOrder::chains, 0};
    row.device = backend.devices()[0];
    Traced result;
    result.totals.rays = 1000;
    result.totals.hit_steps = 1'000'000;
    row.outcome = result;
    row.samples_s = {1e-3, 1e-3, 1e-3};
    return row;
}

} // namespace

TEST(RowDevices, are_listed_once_by_hardware_emulations_last)
{
    static FakeBackend opencl("opencl", device("PoCL", DeviceKind::emulated)),
        cuda("cuda", device("GPU", DeviceKind::gpu, "a")), vulkan("vulkan", device("GPU", DeviceKind::gpu, "a")),
        openmp("openmp", device("CPU", DeviceKind::cpu));
    const auto rows = list(row_on(opencl), row_on(cuda), row_on(openmp), row_on(vulkan), row_on(openmp));
    const auto devices = devices_of(rows);
    std::string order;
    for (const RowDevice& found : devices)
        order += found.backend + std::to_string(found.hardware) + " ";
    EXPECT_EQ(order, "openmp0 opencl0 cuda1 vulkan1 ");
    EXPECT_EQ(device_of(rows[2], devices), std::size_t{0});
    EXPECT_FALSE(device_of(RowRecord{}, devices).has_value());
}

TEST(RowDevices, bandwidth_is_a_share_of_that_of_the_rows_own_device)
{
    static FakeBackend slow("a", device("slow", DeviceKind::gpu, "a")), fast("b", device("fast", DeviceKind::gpu, "b"));
    slow.measure = [] { return Yardstick{88e9, 1e-6}; };
    fast.measure = [] { return Yardstick{440e9, 1e-6}; };
    const auto rows = list(row_on(slow), row_on(fast));
    auto devices = devices_of(rows);
    EXPECT_FALSE(copy_shares(rows[0], devices).has_value()) << "not measured yet";
    measure_devices(devices, {}, {&slow, &fast});
    EXPECT_DOUBLE_EQ(copy_shares(rows[0], devices).value().of_memory, 0.5);
    EXPECT_DOUBLE_EQ(copy_shares(rows[1], devices).value().of_memory, 0.1);
}

TEST(RowDevices, a_row_s_ceiling_is_that_of_the_level_that_holds_its_scene)
{
    static FakeBackend gpu("a", device("GPU", DeviceKind::gpu, "a"));
    gpu.measure = [] {
        return Yardstick{44e9, 1e-6, {{{1'000, 30e9}, {4'000, 176e9}, {16'000, 88e9}, {64'000, 44e9}}}};
    };
    for (const auto& [bytes, ceiling] :
         {std::pair(500, 176e9), {4'000, 176e9}, {4'001, 88e9}, {64'000, 44e9}, {1 << 30, 44e9}}) {
        auto rows = list(row_on(gpu));
        rows[0].setup.bytes = bytes;
        auto devices = devices_of(rows);
        measure_devices(devices, {}, {&gpu});
        const CopyShares shares = copy_shares(rows[0], devices).value();
        EXPECT_EQ(shares.ceiling_bytes_per_s, ceiling) << bytes;
        EXPECT_DOUBLE_EQ(shares.of_ceiling, 44e9 / ceiling) << bytes;
        EXPECT_DOUBLE_EQ(shares.of_memory, 1) << bytes;
    }
}

TEST(Yardstick, copies_at_sizes_from_caches_to_memory_and_each_long_enough)
{
    constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;
    const ScopedVariable none("TETRACE_QUICK_COPIES", static_cast<const char*>(nullptr));
    // 100 GB/s from a cache of 20 MiB, 10 GB/s outside it, and a microsecond for each copy.
    const Yardstick measured = measure_copies(512 * mebibyte, [](std::uint64_t bytes, unsigned times) {
        return times * (1e-6 + 2.0 * static_cast<double>(bytes) / (2 * bytes > 20 * mebibyte ? 10e9 : 100e9));
    });
    for (std::size_t i = 0; i < measured.copies.size(); ++i) {
        EXPECT_EQ(measured.copies[i].bytes, mebibyte << (2 * i));
        EXPECT_NEAR(measured.copies[i].bytes_per_s, i < 3 ? 100e9 : 10e9, i == 0 ? 10e9 : 3e9) << i;
    }
    EXPECT_EQ(measured.copy_bytes_per_s, measured.copies.back().bytes_per_s);
    const Yardstick small = measure_copies(100, [](std::uint64_t, unsigned times) { return 1e-3 * times; });
    EXPECT_EQ(small.copies[0].bytes, 200u);
    EXPECT_GT(small.copy_bytes_per_s, 0);
    EXPECT_EQ(copied_bytes(std::uint64_t{80} << 30, 0), 512 * mebibyte);
    EXPECT_EQ(copied_bytes(std::uint64_t{2} << 30, 0), 256 * mebibyte);
    EXPECT_EQ(copied_bytes(std::uint64_t{80} << 30, 1023), 1020u);
    const ScopedVariable quick("TETRACE_QUICK_COPIES", "1");
    EXPECT_EQ(copied_bytes(std::uint64_t{80} << 30, 0), mebibyte);
}

TEST(RowDevices, an_api_on_the_host_without_a_yardstick_has_openmps_and_one_on_a_gpu_none)
{
    static FakeBackend host("host", device("CPU", DeviceKind::cpu)), gpu("gpu", device("GPU", DeviceKind::gpu));
    auto devices = devices_of(list(row_on(host), row_on(gpu)));
    measure_devices(devices, {.threads = 1}, {&host, &gpu});
    ASSERT_TRUE(devices[0].yardstick.has_value());
    EXPECT_GT(devices[0].yardstick->copy_bytes_per_s, 0);
    EXPECT_FALSE(devices[1].yardstick.has_value());
}

TEST(RowDevices, a_device_that_fails_keeps_the_reason_and_the_others_are_measured)
{
    static FakeBackend lost("lost", device("lost", DeviceKind::gpu, "a")),
        good("good", device("good", DeviceKind::gpu, "b"));
    lost.measure = []() -> std::optional<Yardstick> { throw Error(ErrorKind::internal, "the device was lost"); };
    good.measure = [] { return Yardstick{1e9, 1e-6}; };
    auto devices = devices_of(list(row_on(lost), row_on(good)));
    measure_devices(devices, {}, {&lost, &good});
    EXPECT_EQ(devices[0].problem, "microbenchmark: the device was lost");
    EXPECT_EQ(devices[1].problem, "");
    EXPECT_TRUE(devices[1].yardstick.has_value());
}
