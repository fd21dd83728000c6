#include "core/isolation/own_gpu.h"
#include "tests/support/fake_backend.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

Device device(const char* name, DeviceKind kind, const char* pci = "", bool usable = true)
{
    Device made;
    made.name = name;
    made.kind = kind;
    made.pci = pci;
    made.usable = usable;
    return made;
}

/// Several devices; opening one gives an error with its number.
class FakeMachine : public test::FakeBackend {
public:
    explicit FakeMachine(std::vector<Device> devices)
        : FakeBackend("fake", devices.front()), devices_(std::move(devices))
    {
    }
    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }
    [[nodiscard]] std::string why_not(std::size_t index, const KernelId&) const override
    {
        return devices_.at(index).name;
    }

private:
    std::vector<Device> devices_;
};

std::vector<std::string> names_for(unsigned local, const std::vector<Device>& devices)
{
    FakeMachine machine(devices);
    set_own_gpu(local);
    const auto own = with_own_gpu({&machine});
    std::vector<std::string> names;
    for (std::size_t i = 0; i < own.front()->devices().size(); ++i) {
        names.push_back(own.front()->devices()[i].name);
        EXPECT_EQ(own.front()->why_not(i, {}), names.back()) << "calls go to the device of that name";
    }
    return names;
}

using Names = std::vector<std::string>;

} // namespace

TEST(OwnGpu, each_rank_of_a_machine_takes_another_and_keeps_what_is_no_gpu)
{
    const std::vector<Device> devices = {device("a", DeviceKind::gpu), device("b", DeviceKind::gpu),
                                         device("llvmpipe", DeviceKind::emulated)};
    EXPECT_EQ(names_for(0, devices), (Names{"a", "llvmpipe"}));
    EXPECT_EQ(names_for(1, devices), (Names{"b", "llvmpipe"}));
    EXPECT_EQ(names_for(2, devices), (Names{"a", "llvmpipe"})) << "more ranks than GPUs share them";
}

TEST(OwnGpu, gpus_are_identified_by_their_address_if_all_have_one)
{
    EXPECT_EQ(
        names_for(0, {device("far", DeviceKind::gpu, "0000:c1:00.0"), device("near", DeviceKind::gpu, "0000:41:00.0")}),
        Names{"near"});
    EXPECT_EQ(names_for(0, {device("far", DeviceKind::gpu, "0000:c1:00.0"), device("near", DeviceKind::gpu)}),
              Names{"far"});
}

TEST(OwnGpu, a_machine_without_usable_gpus_keeps_all_its_devices)
{
    EXPECT_EQ(names_for(3, {device("none", DeviceKind::gpu, "", false)}), Names{"none"});
    EXPECT_EQ(names_for(3, {device("cpu", DeviceKind::cpu), device("pocl", DeviceKind::emulated)}),
              (Names{"cpu", "pocl"}));
}
