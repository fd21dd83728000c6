// What decides how fast a machine runs, of made-up machines.
#include "bench/options/host_conditions.h"
#include "bench/output/trust.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Conditions : public testing::Test {
protected:
    void write(const std::string& path, const std::string& text)
    {
        std::filesystem::create_directories((root_ / path).parent_path());
        write_file(root_ / path, text);
    }
    void have_supply(const std::string& name, const std::string& type, const std::string& key, const std::string& value)
    {
        write("sys/class/power_supply/" + name + "/type", type + "\n");
        write("sys/class/power_supply/" + name + "/" + key, value + "\n");
    }
    [[nodiscard]] nlohmann::json recorded() const { return conditions_json(host_conditions(root_.path())); }

    TemporaryFolder root_;
    const std::string cpu_ = "sys/devices/system/cpu/";
};

} // namespace

TEST_F(Conditions, that_the_system_does_not_report_are_left_out)
{
    EXPECT_EQ(recorded(), nlohmann::json::object());
    write(cpu_ + "cpufreq/boost", "maybe\n");
    write(cpu_ + "smt/active", "");
    write("proc/meminfo", "nonsense");
    EXPECT_EQ(recorded(), nlohmann::json::object());
}

TEST_F(Conditions, are_those_of_proc_and_sys)
{
    for (const char* const policy : {"policy0", "policy4"})
        write(cpu_ + "cpufreq/" + policy + "/scaling_governor", policy[6] == '0' ? "schedutil\n" : "performance\n");
    write(cpu_ + "cpufreq/boost", "1\n");
    write(cpu_ + "smt/active", "0\n");
    write("proc/meminfo", "MemTotal:        2000000 kB\nMemFree: 1 kB\n");
    write("proc/self/cgroup", "0::/\n");
    write("proc/self/mountinfo", "30 22 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
    write("sys/fs/cgroup/cpu.max", "150000 100000\n");
    write("sys/fs/cgroup/memory.max", "1000000\n");
    have_supply("AC", "Mains", "online", "1");
    EXPECT_EQ(recorded(), nlohmann::json::parse(R"({ "governor": "performance, schedutil", "turbo": true, "smt": false,
        "memory_bytes": 2048000000, "cpu_limit": 1.5, "memory_limit_bytes": 1000000, "on_battery": false })"));
}

TEST_F(Conditions, turbo_is_also_the_opposite_of_intels_no_turbo_and_a_policys_boost)
{
    write(cpu_ + "cpufreq/policy0/boost", "0\n");
    EXPECT_EQ(host_conditions(root_.path()).turbo, false);
    write(cpu_ + "cpufreq/policy1/boost", "1\n");
    EXPECT_EQ(host_conditions(root_.path()).turbo, true);
    write(cpu_ + "intel_pstate/no_turbo", "1\n");
    EXPECT_EQ(host_conditions(root_.path()).turbo, false);
}

TEST_F(Conditions, a_battery_counts_while_it_discharges_and_is_the_machines)
{
    have_supply("mouse", "Battery", "status", "Discharging");
    write("sys/class/power_supply/mouse/scope", "Device\n");
    EXPECT_EQ(host_conditions(root_.path()).on_battery, std::nullopt);
    have_supply("BAT0", "Battery", "status", "Charging");
    EXPECT_EQ(host_conditions(root_.path()).on_battery, false);
    have_supply("BAT0", "Battery", "status", "Discharging");
    EXPECT_EQ(host_conditions(root_.path()).on_battery, true);
    have_supply("AC", "Mains", "online", "1");
    EXPECT_EQ(host_conditions(root_.path()).on_battery, false);
}

TEST_F(Conditions, that_slow_a_machine_are_named_by_trust)
{
    Steadiness steadiness;
    steadiness.timed = 4;
    const auto trust = [&] { return trust_text(steadiness); };
    EXPECT_EQ(trust(), "the load while measuring is not known; 0 of 4 rows noisy.");
    steadiness.conditions.governor = "performance";
    steadiness.conditions.on_battery = false;
    EXPECT_FALSE(contains(trust(), "governor") || contains(trust(), "battery"));
    steadiness.conditions.governor = "powersave";
    EXPECT_TRUE(contains(trust(), "; the CPUs' frequency governor is powersave; 0 of 4 rows noisy.")) << trust();
    steadiness.conditions.on_battery = true;
    EXPECT_TRUE(contains(trust(), "powersave, on battery; 0 of 4")) << trust();
    steadiness.conditions.governor = "";
    EXPECT_TRUE(contains(trust(), "; the machine ran on its battery; 0 of 4")) << trust();
    const nlohmann::json section = {{"conditions", conditions_json(steadiness.conditions)}};
    EXPECT_EQ(read_steadiness(ResultValue(section, "r.json")).conditions.on_battery, true);
}
