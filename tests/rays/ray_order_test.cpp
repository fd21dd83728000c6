#include "core/rays/ray_order.h"

#include "core/base/hash.h"
#include "tests/support/given_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

RaySet arranged(RayKind kind, RayOrder order)
{
    static const GivenScene given;
    RaySet set = make_rays(kind, given.source());
    arrange(set, order);
    return set;
}

// By pixel, which names a ray.
std::vector<GivenRay> sorted(std::vector<GivenRay> rays)
{
    std::sort(rays.begin(), rays.end(), [](const auto& a, const auto& b) { return a.pixel < b.pixel; });
    return rays;
}

// Mean distance of a ray's origin and direction from those of the ray before it.
double mean_jump(const RaySet& set)
{
    double sum = 0;
    for (std::size_t i = 1; i < set.rays.size(); ++i)
        sum += length(to_double(set.rays[i].origin) - to_double(set.rays[i - 1].origin)) +
               length(to_double(set.rays[i].direction) - to_double(set.rays[i - 1].direction));
    return sum / static_cast<double>(set.rays.size());
}

} // namespace

TEST(RayOrder, keeps_every_ray)
{
    for (const RayKind kind : {RayKind::primary, RayKind::ao, RayKind::random})
        for (const RayOrder order : {RayOrder::tiles, RayOrder::morton, RayOrder::shuffled}) {
            const RaySet set = arranged(kind, order);
            EXPECT_EQ(set.order, order);
            EXPECT_TRUE(sorted(set.rays) == sorted(arranged(kind, RayOrder::tiles).rays));
        }
}

TEST(RayOrder, is_the_same_on_every_machine)
{
    EXPECT_EQ(hash_text(ray_hash(arranged(RayKind::ao, RayOrder::morton))), "a071dbc0e09b24fd");
    EXPECT_EQ(hash_text(ray_hash(arranged(RayKind::ao, RayOrder::shuffled))), "099ce7a9c447faa0");
}

TEST(RayOrder, tiles_are_those_of_8_by_8_pixels)
{
    const RaySet set = arranged(RayKind::primary, RayOrder::tiles);
    for (std::uint32_t i = 0; i < set.rays.size(); ++i) {
        const std::uint32_t tile = i / 64, item = i % 64;
        ASSERT_EQ(set.rays[i].pixel, (tile / 8 * 8 + item / 8) * 64 + tile % 8 * 8 + item % 8);
    }
}

TEST(RayOrder, morton_is_more_coherent_than_tiles_and_shuffled_less)
{
    // Random rays are made without an order.
    const double morton = mean_jump(arranged(RayKind::random, RayOrder::morton));
    const double tiles = mean_jump(arranged(RayKind::random, RayOrder::tiles));
    EXPECT_LT(morton, 0.75 * tiles);
    // Primary ones have.
    EXPECT_GT(mean_jump(arranged(RayKind::primary, RayOrder::shuffled)),
              4 * mean_jump(arranged(RayKind::primary, RayOrder::tiles)));
}

TEST(RayOrder, morton_goes_by_cells_of_origins_first)
{
    RaySet set;
    const auto ray = [](float x, float y, float dx) {
        return GivenRay{{x, y, 0}, {dx, 0, 0}, NO_END, NO_HALF_FACE, FREE_FACE, 0};
    };
    set.rays = {ray(1, 1, 1), ray(0, 1, 1), ray(1, 0, 1), ray(0, 0, 1), ray(0.001F, 0, -1), ray(0, 0.001F, 1)};
    const std::vector<GivenRay> expected = {set.rays[4], set.rays[3], set.rays[5],
                                            set.rays[1], set.rays[2], set.rays[0]};
    arrange(set, RayOrder::morton);
    EXPECT_TRUE(set.rays == expected);
}

TEST(RayOrder, an_empty_set_stays_empty)
{
    for (const RayOrder order : {RayOrder::tiles, RayOrder::morton, RayOrder::shuffled}) {
        RaySet set;
        arrange(set, order);
        EXPECT_TRUE(set.rays.empty());
    }
}
