#include "bench/rows/physical_device.h"

#include "tests/rows/gpu_device.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Numbers = std::vector<std::size_t>;

Device host(DeviceKind kind)
{
    Device device;
    device.kind = kind;
    return device;
}

Device missing()
{
    Device device;
    device.usable = false;
    return device;
}

Numbers numbers_of(std::vector<Device> devices)
{
    return physical_devices(devices);
}

} // namespace

TEST(PhysicalDevices, what_runs_on_the_host_is_one_whatever_its_uuid)
{
    Device lavapipe = host(DeviceKind::emulated);
    lavapipe.uuid = "6d657361";
    EXPECT_EQ(numbers_of({host(DeviceKind::cpu), gpu("a", ""), lavapipe, host(DeviceKind::emulated)}),
              (Numbers{0, 1, 0, 0}));
}

TEST(PhysicalDevices, a_gpu_is_known_by_its_uuid_else_by_its_pci_address)
{
    EXPECT_EQ(numbers_of({gpu("a", "0000:41:00.0"), gpu("a", ""), gpu("", "0000:41:00.0"), gpu("b", "0000:42:00.0")}),
              (Numbers{0, 0, 0, 1}));
}

TEST(PhysicalDevices, instances_of_a_divided_gpu_stay_apart)
{
    EXPECT_EQ(numbers_of({gpu("a", "0000:41:00.0"), gpu("b", "0000:41:00.0")}), (Numbers{0, 1}));
}

TEST(PhysicalDevices, a_device_that_knows_both_names_joins_two_that_know_one_each)
{
    EXPECT_EQ(numbers_of({gpu("", "0000:41:00.0"), gpu("a", ""), gpu("b", ""), gpu("a", "0000:41:00.0")}),
              (Numbers{0, 0, 1, 0}));
}

TEST(PhysicalDevices, nameless_gpus_and_what_is_missing_are_never_one)
{
    EXPECT_EQ(numbers_of({gpu("", ""), gpu("", ""), missing(), missing(), host(DeviceKind::cpu)}),
              (Numbers{0, 1, 2, 3, 4}));
    Device unusable = host(DeviceKind::emulated);
    unusable.usable = false;
    EXPECT_EQ(numbers_of({host(DeviceKind::cpu), unusable}), (Numbers{0, 1}));
}
