#include "bench/measuring/row_devices.h"

#include "tests/support/fake_backend.h"
#include "tests/support/row_runs.h"

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
RowRun row_of(Backend& backend)
{
    RowRun row;
    row.key = {"a", backend.name(), {}, RayKind::primary, TetOrder::hilbert, 0};
    row.backend = &backend;
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
    const auto rows = list(row_of(opencl), row_of(cuda), row_of(openmp), row_of(vulkan), row_of(openmp));
    const auto devices = devices_of(rows);
    std::string order;
    for (const RowDevice& found : devices)
        order += found.backend->name() + std::to_string(found.hardware) + " ";
    EXPECT_EQ(order, "openmp0 opencl0 cuda1 vulkan1 ");
    EXPECT_EQ(device_of(rows[2], devices), std::size_t{0});
    EXPECT_FALSE(device_of(RowRun{}, devices).has_value());
}

TEST(RowDevices, bandwidth_is_a_share_of_that_of_the_rows_own_device)
{
    static FakeBackend slow("a", device("slow", DeviceKind::gpu, "a")), fast("b", device("fast", DeviceKind::gpu, "b"));
    slow.measure = [] { return Yardstick{88e9, 1e-6}; };
    fast.measure = [] { return Yardstick{440e9, 1e-6}; };
    const auto rows = list(row_of(slow), row_of(fast));
    auto devices = devices_of(rows);
    EXPECT_FALSE(share_of_copy(rows[0], devices).has_value()) << "not measured yet";
    measure_devices(devices, {});
    EXPECT_DOUBLE_EQ(share_of_copy(rows[0], devices).value(), 0.5);
    EXPECT_DOUBLE_EQ(share_of_copy(rows[1], devices).value(), 0.1);
}

TEST(RowDevices, an_api_on_the_host_without_a_yardstick_has_openmps_and_one_on_a_gpu_none)
{
    static FakeBackend host("host", device("CPU", DeviceKind::cpu)), gpu("gpu", device("GPU", DeviceKind::gpu));
    auto devices = devices_of(list(row_of(host), row_of(gpu)));
    measure_devices(devices, {.threads = 1});
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
    auto devices = devices_of(list(row_of(lost), row_of(good)));
    measure_devices(devices, {});
    EXPECT_EQ(devices[0].problem, "yardstick: the device was lost");
    EXPECT_EQ(devices[1].problem, "");
    EXPECT_TRUE(devices[1].yardstick.has_value());
}
