// The domain's outline, by which packets leave out squares of pixels (docs/spec/packets.md, K11).
#include "backends/openmp/outline.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace tetrace::openmp;

namespace {

// The box [0, 1] x [0, 2] x [0, 3] in two divisions, seen from a place.
PacketJob outline_from(float x, float y, float z)
{
    static constexpr float lines[] = {0, 0.5F, 1, 0, 1, 2, 0, 1.5F, 3};
    PacketJob job{};
    job.lines = lines;
    job.divisions = 2;
    job.origin[0] = x;
    job.origin[1] = y;
    job.origin[2] = z;
    set_outline(job);
    return job;
}

// Of the direction to a place: positive on the inner side of the edge's plane.
double side_of(const PacketJob& job, unsigned edge, double x, double y, double z)
{
    const double* const normal = job.outline[edge].normal;
    return normal[0] * (x - job.origin[0]) + normal[1] * (y - job.origin[1]) + normal[2] * (z - job.origin[2]);
}

// How many of the box's corners lie in the planes of the outline, counted for each plane.
unsigned corners_on_outline(const PacketJob& job)
{
    unsigned count = 0;
    for (unsigned edge = 0; edge < job.outline_edges; ++edge)
        for (unsigned corner = 0; corner < 8; ++corner) {
            const double side = side_of(job, edge, corner & 1u ? 1 : 0, corner & 2u ? 2 : 0, corner & 4u ? 3 : 0);
            EXPECT_GE(side, 0) << "the whole box is on the inner side of each edge";
            count += side == 0 ? 1 : 0;
        }
    return count;
}

} // namespace

TEST(Outline, has_four_edges_for_a_camera_that_sees_one_side)
{
    const PacketJob job = outline_from(0.5F, 1, -4);
    ASSERT_EQ(job.outline_edges, 4u);
    EXPECT_EQ(corners_on_outline(job), 8u) << "two ends of each";
}

TEST(Outline, has_six_edges_for_a_camera_that_sees_two_sides_or_three)
{
    for (const PacketJob& job : {outline_from(-2, 5, 1), outline_from(4, 8, -8)}) {
        ASSERT_EQ(job.outline_edges, 6u);
        EXPECT_EQ(corners_on_outline(job), 12u);
    }
}

TEST(Outline, parts_directions_to_the_box_from_those_beside_it)
{
    const PacketJob job = outline_from(4, 8, -8);
    double least = 1, beside = 1;
    for (unsigned edge = 0; edge < job.outline_edges; ++edge) {
        least = std::min(least, side_of(job, edge, 0.5, 1, 1.5) - job.outline[edge].doubt);
        beside = std::min(beside, side_of(job, edge, 0.5, -4, 1.5) + job.outline[edge].doubt);
    }
    EXPECT_GT(least, 0) << "the middle is inside without a doubt";
    EXPECT_LT(beside, 0) << "the way to that place passes the box where x is above 1 without a doubt";
}

TEST(Outline, has_no_edges_for_a_camera_inside_or_on_a_side)
{
    EXPECT_EQ(outline_from(0.5F, 1, 1).outline_edges, 0u);
    EXPECT_EQ(outline_from(0.5F, 1, 0).outline_edges, 0u);
}
