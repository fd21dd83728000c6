#include "bench/measuring/machine_load.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tetrace;

namespace {

// Of Linux: user, nice, system, idle, waiting, interrupts, soft interrupts, stolen, and guests once more.
constexpr const char* shown = "cpu  111 0 0 900 0 0 0 0 0 0\n"
                              "cpu0 10 2 3 400 50 1 1 4 0 0\n"
                              "cpu1 100 0 0 400 50 0 0 0 7 7\n"
                              "intr 12345\n";

double seconds_of_children()
{
    rusage own{};
    const double all = own_seconds();
    ::getrusage(RUSAGE_SELF, &own);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return all - seconds(own.ru_utime) - seconds(own.ru_stime);
}

} // namespace

TEST(MachineLoad, counts_all_work_but_neither_idling_nor_waiting)
{
    EXPECT_EQ(busy_ticks(shown, {0}), 21.0);
    EXPECT_EQ(busy_ticks(shown, {0, 1}), 121.0);
}

TEST(MachineLoad, is_unknown_where_the_system_shows_no_such_processor)
{
    EXPECT_FALSE(busy_ticks(shown, {2}).has_value());
    EXPECT_FALSE(busy_ticks("", {0}).has_value());
}

TEST(MachineLoad, is_quiet_up_to_a_tenth_of_each_processor)
{
    EXPECT_TRUE((MachineLoad{0.2, 2, 2}.is_quiet()));
    EXPECT_FALSE((MachineLoad{0.21, 2, 2}.is_quiet()));
}

TEST(MachineLoad, of_a_process_is_its_own_work_and_that_of_its_ended_children)
{
    const auto process =
        process_times("4711 (a (strange) name) S 42 4711 1 0 -1 4194560 17 18 0 0 100 20 3 4 20 0 1 0 123");
    ASSERT_TRUE(process.has_value());
    EXPECT_EQ(process->parent, 42);
    EXPECT_EQ(process->ticks, 127);
    EXPECT_EQ(process->started, 123u);
    EXPECT_FALSE(process_times("").has_value());
    EXPECT_FALSE(process_times("4711 (cut) S 42 4711").has_value());
}

// Drivers run in children of tetrace: their rows must not look disturbed by themselves.
TEST(MachineLoad, counts_the_work_of_a_child_as_its_own_while_it_runs_and_once_it_has_ended)
{
    const double before = seconds_of_children();
    const pid_t child = ::fork();
    if (child == 0)
        for (;;) // works until it is ended
            continue;
    ASSERT_GT(child, 0);
    const auto ticks = [child] {
        const std::ifstream file("/proc/" + std::to_string(child) + "/stat");
        std::ostringstream text;
        text << file.rdbuf();
        return process_times(text.str()).value_or(ProcessTimes{}).ticks;
    };
    while (ticks() < 3)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    // This process's own work between two readings is far less than half a tick.
    const double least = before + 2.5 / static_cast<double>(::sysconf(_SC_CLK_TCK));
    EXPECT_GT(seconds_of_children(), least) << "while it runs";
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_GT(seconds_of_children(), least) << "once it has ended";
}

TEST(MachineLoad, of_others_is_not_negative)
{
    const LoadMeter meter;
    const auto load = meter.load();
    EXPECT_GE(load ? load->others : 0, 0);
}
