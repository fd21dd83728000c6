#include "bench/rows/ray_json.h"
#include "core/rays/segments.h"

#include <gtest/gtest.h>

using namespace tetrace;

// Viewed as floats, some of these words are NaNs and denormals.
TEST(RayJson, an_answer_of_task_segments_keeps_every_bit)
{
    const Segments ours{7, 9, 0x7FC00001u, 0xFFFFFFFFu, 1, 12}, openmps{LOST, NO_TET, 1, 0x00000001u, 0, 0};
    DifferingRay differing{1, 2, 3, as_hit(ours), as_hit(openmps), Task::segments};
    const auto text = nlohmann::json::parse(differing_ray_json(differing).dump());
    const DifferingRay read = differing_ray_from(text);
    EXPECT_EQ(read.task, Task::segments);
    EXPECT_EQ(segments_of(read.ours), ours);
    EXPECT_EQ(segments_of(read.openmp), openmps);

    const WrongRay wrong{.view = 1, .x = 2, .y = 3, .ours = as_hit(ours), .reason = "why", .task = Task::segments};
    const WrongRay again = wrong_ray_from(nlohmann::json::parse(wrong_ray_json(wrong).dump()));
    EXPECT_EQ(again.task, Task::segments);
    EXPECT_EQ(segments_of(again.ours), ours);
    EXPECT_EQ(again.reason, "why");
}
