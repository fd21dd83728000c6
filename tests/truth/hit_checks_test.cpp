#include "bench/truth/hit_checks.h"
#include "core/base/exact.h"

#include "core/base/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace tetrace;

namespace {

constexpr Hit right_hit{0, 7, 1.0f, 0.25f, 0.5f, 3};

} // namespace

TEST(CompareHits, equal_hits_do_not_differ)
{
    const std::vector<Hit> hits = {right_hit, {NO_HIT, 3, 0, 0, 0, 9}};
    const Differences found = compare_hits(hits, hits, {});
    EXPECT_EQ(found.count, 0u);
    EXPECT_EQ(found.inexact, 0u);
}

TEST(CompareHits, face_tet_and_steps_must_be_the_same_bits)
{
    for (std::uint32_t Hit::*member : {&Hit::face_id, &Hit::tet, &Hit::steps}) {
        std::vector<Hit> hits(5, right_hit);
        hits[3].*member += 1;
        const Differences found = compare_hits(hits, std::vector<Hit>(5, right_hit), {.ulps = 3});
        EXPECT_EQ(found.count, 1u);
        EXPECT_EQ(found.first, 3u);
    }
}

TEST(CompareHits, parameters_may_differ_by_the_units_allowed_and_no_more)
{
    for (float Hit::*member : {&Hit::t, &Hit::u, &Hit::v}) {
        std::vector<Hit> hits(1, right_hit);
        for (unsigned ulp = 1; ulp <= 4; ++ulp) {
            hits[0].*member = std::nextafter(hits[0].*member, 2.0f);
            const Differences found = compare_hits(hits, std::vector<Hit>(1, right_hit), {.ulps = 3});
            EXPECT_EQ(found.count, ulp <= 3 ? 0u : 1u) << ulp;
            EXPECT_EQ(found.inexact, 1u);
            EXPECT_EQ(found.max_ulps, ulp <= 3 ? ulp : 0u);
            EXPECT_EQ(compare_hits(hits, std::vector<Hit>(1, right_hit), {}).count, 1u);
        }
    }
}

TEST(CompareHits, without_a_tolerance_the_sign_of_zero_counts)
{
    const std::vector<Hit> plus(1, {NO_HIT, 3, 0.0f, 0, 0, 9}), minus(1, {NO_HIT, 3, -0.0f, 0, 0, 9});
    EXPECT_EQ(compare_hits(minus, plus, {}).count, 1u);
    const Differences allowed = compare_hits(minus, plus, {.ulps = 3});
    EXPECT_EQ(allowed.count, 0u);
    EXPECT_EQ(allowed.inexact, 1u);
}

TEST(CompareHits, either_triangle_will_do_where_any_hit_answers)
{
    const std::vector<Hit> ours = {{7, NO_TET, 0.5f, 0, 0, 0}, {NO_HIT, NO_TET, 0, 0, 0, 0}, {LOST, 3, 0, 0, 0, 9}};
    const std::vector<Hit> theirs(3, {8, NO_TET, 0.75f, 0, 0, 0});
    EXPECT_EQ(compare_hits(ours, theirs, {.ulps = 3}).count, 3u);
    const Differences found = compare_hits(ours, theirs, {.ulps = 3, .any_triangle = true});
    EXPECT_EQ(found.count, 2u) << "a miss and a lost ray are not hits";
    EXPECT_EQ(found.inexact, 3u);
    EXPECT_EQ(found.max_ulps, 0u) << "parameters on different triangles are not compared";
    EXPECT_EQ(compare_hits(theirs, ours, {.ulps = 3, .any_triangle = true}).count, 2u);
}

TEST(CompareHits, images_of_different_sizes_are_an_error)
{
    EXPECT_THROW(static_cast<void>(compare_hits(std::vector<Hit>(2), std::vector<Hit>(3), {})), Error);
}

TEST(UlpsBetween, counts_floats_between_and_knows_signs)
{
    EXPECT_EQ(ulps_between(1.0f, 1.0f), 0u);
    EXPECT_EQ(ulps_between(0.0f, -0.0f), 0u);
    EXPECT_EQ(ulps_between(1.0f, std::nextafter(1.0f, 0.0f)), 1u);
    EXPECT_EQ(ulps_between(-1.0f, std::nextafter(-1.0f, -2.0f)), 1u);
    EXPECT_GT(ulps_between(1.0f, -1.0f), 1000u);
    EXPECT_GT(ulps_between(1.0f, std::numeric_limits<float>::quiet_NaN()), 1000u);
}

TEST(CountRays, reports_the_outcome_of_each)
{
    const std::vector<Hit> hits = {
        right_hit, right_hit, {NO_HIT, 0, 0, 0, 0, 5}, {LOST, 0, 0, 0, 0, 100}, {POISON, 0, 0, 0, 0, 0}};
    RayTotals totals = count_rays(hits);
    totals.add(count_rays(hits));
    EXPECT_EQ(totals.rays, 10u);
    EXPECT_EQ(totals.hits, 4u);
    EXPECT_EQ(totals.misses, 2u);
    EXPECT_EQ(totals.lost, 2u);
    EXPECT_EQ(totals.unwritten, 2u);
    EXPECT_EQ(totals.hit_steps, 12u);
    EXPECT_EQ(totals.miss_steps, 10u);
    EXPECT_EQ(totals.steps(), 222u);
}
