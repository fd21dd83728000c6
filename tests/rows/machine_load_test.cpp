#include "bench/measuring/machine_load.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

// Of Linux: user, nice, system, idle, waiting, interrupts, soft interrupts, stolen, and guests once more.
constexpr const char* shown = "cpu  111 0 0 900 0 0 0 0 0 0\n"
                              "cpu0 10 2 3 400 50 1 1 4 0 0\n"
                              "cpu1 100 0 0 400 50 0 0 0 7 7\n"
                              "intr 12345\n";

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

TEST(MachineLoad, of_others_is_not_negative)
{
    const LoadMeter meter;
    const auto load = meter.load();
    EXPECT_GE(load ? load->others : 0, 0);
}
