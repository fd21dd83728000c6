#include "core/pack/pack_cwbvh.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<Double3> random_offsets(std::size_t count, Random& random)
{
    std::vector<Double3> offsets;
    for (std::size_t i = 0; i < count; ++i)
        offsets.push_back(to_double(random.point(-1, 1)));
    return offsets;
}

double cost_of(const std::vector<Double3>& offsets, const std::vector<std::uint8_t>& slots)
{
    double cost = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i)
        cost += slot_cost(offsets[i], slots[i]);
    return cost;
}

} // namespace

TEST(OctantSlots, no_assignment_costs_less)
{
    Random random(11);
    for (const std::size_t count : {1u, 2u, 5u, 7u, 8u}) {
        const auto offsets = random_offsets(count, random);
        const double cost = cost_of(offsets, octant_slots(offsets));
        std::vector<std::uint8_t> slots(8);
        std::iota(slots.begin(), slots.end(), std::uint8_t{0});
        double least = 100;
        do {
            least = std::min(least, cost_of(offsets, slots));
        } while (std::next_permutation(slots.begin(), slots.end()));
        EXPECT_NEAR(cost, least, 1e-12) << count << " children";
    }
}

TEST(OctantSlots, each_child_has_its_own_slot)
{
    Random random(12);
    for (std::size_t count = 0; count <= 8; ++count) {
        auto slots = octant_slots(random_offsets(count, random));
        EXPECT_EQ(slots.size(), count);
        std::sort(slots.begin(), slots.end());
        EXPECT_EQ(std::adjacent_find(slots.begin(), slots.end()), slots.end());
        EXPECT_TRUE(count == 0 || slots.back() < 8);
    }
    EXPECT_EQ(octant_slots(std::vector<Double3>(8)).size(), 8u) << "all in one place";
}

// Of children at the corners of a cube, a ray into octant o meets the one in slot o first: it comes from there.
TEST(OctantSlots, the_slot_of_a_rays_octant_has_the_child_that_it_meets_first)
{
    std::vector<Double3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({(i & 4) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 1) != 0 ? 1.0 : -1.0});
    const auto slots = octant_slots(corners);
    for (std::uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(slots[i], i) << "octant " << i << " has negative directions along the axes where the corner is high";
}
