// What is asked of GPUs while rows are timed: NVIDIA's library by a stub, the amdgpu driver's files by a folder.
#include "bench/measuring/gpu_monitor.h"

#include "tests/rows/gpu_device.h"
#include "tests/support/temporary_folder.h"

#include <cstring>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

constexpr const char* gpu_uuid = "00112233445566778899aabbccddeeff";
constexpr const char* gpu_pci = "0000:41:00.0";

class Amdgpu : public testing::Test {
protected:
    Amdgpu()
    {
        write_file(folder_ / "hwmon/hwmon3/name", "amdgpu\n");
        write_file(folder_ / "hwmon/hwmon3/freq1_input", "2304000000\n");
        write_file(folder_ / "hwmon/hwmon3/power1_average", "251000000\n");
        write_file(folder_ / "hwmon/hwmon3/temp1_input", "63000\n");
        write_file(folder_ / "pp_dpm_sclk", "0: 500Mhz\n1: 2304Mhz *\n");
        write_file(folder_ / "pp_dpm_mclk", "0: 96Mhz\n1: 1000Mhz *\n");
    }
    void write_metrics(char content, std::uint32_t throttling)
    {
        std::string bytes(120, '\0');
        bytes[2] = 1;
        bytes[3] = content;
        std::memcpy(bytes.data() + 68, &throttling, sizeof throttling);
        write_file(folder_ / "gpu_metrics", bytes);
    }
    [[nodiscard]] GpuState told() const { return amdgpu_monitor(gpu("", gpu_pci), root_.path())->read(); }

    TemporaryFolder root_;
    fs::path folder_ = root_ / "bus/pci/devices" / gpu_pci;
};

} // namespace

TEST(Nvml, reports_clocks_power_and_heat_of_a_gpu_by_its_uuid_or_its_address)
{
    for (const Device& device : {gpu(gpu_uuid, ""), gpu("", gpu_pci), gpu(gpu_uuid, gpu_pci)}) {
        const auto monitor = nvml_monitor(device, TETRACE_STUB_NVML_LIBRARY);
        ASSERT_NE(monitor, nullptr);
        const GpuState state = monitor->read();
        EXPECT_EQ(state.clock_mhz, 1980);
        EXPECT_EQ(state.memory_clock_mhz, 2619);
        EXPECT_EQ(state.power_w, 412.5);
        EXPECT_EQ(state.temperature_c, 51);
        EXPECT_EQ(state.throttled, "");
    }
}

TEST(Nvml, reports_what_throttles_but_not_what_the_user_asked_for)
{
    for (const auto& [word, text] :
         {std::pair("4", "power"), {"64", "hardware heat"}, {"36", "power, heat"}, {"19", ""}}) {
        const ScopedVariable bits("TETRACE_STUB_NVML", word);
        EXPECT_EQ(nvml_monitor(gpu(gpu_uuid, ""), TETRACE_STUB_NVML_LIBRARY)->read().throttled, text) << word;
    }
}

TEST(Nvml, that_is_missing_does_not_start_or_does_not_know_the_gpu_reports_nothing)
{
    EXPECT_EQ(nvml_monitor(gpu(gpu_uuid, gpu_pci), "libof-no-such-name.so.1"), nullptr);
    EXPECT_EQ(nvml_monitor(gpu("ffffffffffffffffffffffffffffffff", "0000:42:00.0"), TETRACE_STUB_NVML_LIBRARY),
              nullptr);
    EXPECT_EQ(nvml_monitor(gpu("", ""), TETRACE_STUB_NVML_LIBRARY), nullptr);
    const ScopedVariable broken("TETRACE_STUB_NVML", "broken");
    EXPECT_EQ(nvml_monitor(gpu(gpu_uuid, gpu_pci), TETRACE_STUB_NVML_LIBRARY), nullptr);
}

TEST_F(Amdgpu, reports_what_the_driver_s_files_have)
{
    const GpuState state = told();
    EXPECT_EQ(state.clock_mhz, 2304);
    EXPECT_EQ(state.memory_clock_mhz, 1000);
    EXPECT_EQ(state.power_w, 251);
    EXPECT_EQ(state.temperature_c, 63);
    EXPECT_EQ(state.throttled, "");
}

TEST_F(Amdgpu, leaves_out_what_has_no_file)
{
    for (const char* const name :
         {"hwmon/hwmon3/freq1_input", "hwmon/hwmon3/power1_average", "hwmon/hwmon3/temp1_input"})
        fs::remove(folder_ / name);
    EXPECT_EQ(told().clock_mhz, 2304) << "of the marked line";
    EXPECT_FALSE(told().power_w || told().temperature_c);
    write_file(folder_ / "hwmon/hwmon3/power1_input", "17000000\n");
    EXPECT_EQ(told().power_w, 17);
}

TEST_F(Amdgpu, reports_that_it_throttles_if_its_metrics_are_of_a_known_form)
{
    write_metrics(3, 0);
    EXPECT_EQ(told().throttled, "");
    write_metrics(3, 8);
    EXPECT_EQ(told().throttled, "power or heat");
    write_metrics(3, 0xFFFFFFFFu);
    EXPECT_EQ(told().throttled, "") << "cannot be told";
    write_metrics(9, 8);
    EXPECT_EQ(told().throttled, "") << "another form";
    write_file(folder_ / "gpu_metrics", "short");
    EXPECT_EQ(told().throttled, "");
}

TEST_F(Amdgpu, is_found_by_its_address_and_its_sensors)
{
    EXPECT_EQ(amdgpu_monitor(gpu(gpu_uuid, ""), root_.path()), nullptr);
    EXPECT_EQ(amdgpu_monitor(gpu("", "0000:42:00.0"), root_.path()), nullptr);
    write_file(folder_ / "hwmon/hwmon3/name", "i915\n");
    EXPECT_EQ(amdgpu_monitor(gpu("", gpu_pci), root_.path()), nullptr);
}

TEST(GpuMonitor, there_is_none_for_a_device_on_the_host)
{
    Device emulated = gpu(gpu_uuid, gpu_pci);
    emulated.kind = DeviceKind::emulated;
    EXPECT_EQ(find_gpu_monitor(emulated), nullptr);
}

TEST(GpuReadings, of_other_samples_are_added_and_each_reason_is_named_once)
{
    GpuReadings all{{{1500, {}, {}, {}, "heat"}}, 2, "heat"};
    all.add({{{1700, {}, {}, {}, ""}, {1600, {}, {}, {}, "power, heat"}}, 3, "heat, power"});
    all.add({});
    EXPECT_EQ(all.states.size(), 3u);
    EXPECT_EQ(all.throttled(), 2u);
    EXPECT_EQ(all.dropped, 5u);
    EXPECT_EQ(all.reasons, "heat, power");
    EXPECT_EQ(all.median(&GpuState::clock_mhz), 1600);
}
