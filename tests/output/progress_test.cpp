#include "bench/terminal/progress.h"

#include "bench/terminal/text.h"

#include <chrono>
#include <gtest/gtest.h>
#include <regex>
#include <thread>

using namespace tetrace;

TEST(Progress, shows_stage_time_and_percentage_if_known)
{
    EXPECT_EQ(progress_text("TetGen", 3.21, -1, 80), "TetGen  3.2 s");
    EXPECT_EQ(progress_text("verifying bunny", 75, 0.416, 80), "verifying bunny  1 min 15 s  42 %");
    EXPECT_EQ(progress_text("table4", 75, 0.25, 80, 225), "table4  1 min 15 s  25 %  3 min 45 s left");
}

TEST(Progress, is_cut_at_the_terminals_width_between_characters)
{
    EXPECT_EQ(progress_text("abcdef", 1, -1, 4), "abcd");
    EXPECT_EQ(progress_text("äöüß", 1, -1, 3), "äöü");
}

TEST(Progress, draws_nothing_where_it_may_not_or_before_two_seconds)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine silent(false, true), early(true, true);
        silent.show("work", 0.5);
        early.show("work", 0.5);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, without_a_terminal_is_a_line_now_and_then)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine log(false, true, 0.05);
        log.show("work", 0.25, 3);
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        log.show("work", 0.5, 2, "bvh2");
        log.show("work", 0.75, 1);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "work, bvh2  0.1 s  50 %  2.0 s left\n");
}

TEST(Progress, draws_after_two_seconds_and_leaves_the_line_empty)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine line(true, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(2050));
        line.show("work", 0.5);
    }
    const std::string drawn = testing::internal::GetCapturedStderr();
    EXPECT_EQ(drawn.rfind("\rwork  0.0 s  50 %\r", 0), 0u) << drawn;
    EXPECT_EQ(drawn.back(), '\r');
    EXPECT_EQ(drawn.find('\x1b'), std::string::npos) << "NO_COLOR is honoured";
}

TEST(Progress, shows_the_time_left_of_work_that_knows_its_share)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine line(true, false);
        const tetrace::Progress progress = line.callback();
        progress("optimising", -1, "");
        std::this_thread::sleep_for(std::chrono::milliseconds(2050));
        progress("optimising", 0.25, "round 2");
    }
    const std::string drawn = testing::internal::GetCapturedStderr();
    EXPECT_EQ(drawn.rfind("\roptimising, round 2  2.1 s  25 %  6.2 s left", 0), 0u) << drawn;
}

TEST(Progress, shows_the_time_left_of_every_stage_that_knows_its_share_from_that_stage)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine log(false, true, 0);
        log.show("opening", 0.9);
        log.show("measuring", 0.5); // the rest of a run that was resumed
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        log.show("measuring", 0.75);
        log.show("measuring", 1);
    }
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(std::regex_match(told, std::regex("opening  [^l]* 90 %\n"
                                                  "measuring  [^l]* 50 %\n"
                                                  "measuring  .* 75 %  .* left\n"
                                                  "measuring  .* 100 %  0.0 s left\n")))
        << told;
}

TEST(Progress, names_other_work_at_once_and_keeps_the_time_of_the_stage)
{
    testing::internal::CaptureStderr();
    {
        ProgressLine line(true, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(2050));
        line.show("verifying bunny", 0, -1, "bvh2 on vulkan");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        line.show("verifying bunny", 0, -1, "bvh rt on vulkan, view 2 of 4");
    }
    const std::string drawn = testing::internal::GetCapturedStderr();
    EXPECT_NE(drawn.find("\rverifying bunny, bvh2 on vulkan  0.0 s"), std::string::npos) << drawn;
    EXPECT_NE(drawn.find("\rverifying bunny, bvh rt on vulkan, view 2 of 4  0.0 s"), std::string::npos) << drawn;
}
