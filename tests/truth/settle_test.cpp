#include "bench/truth/settle.h"

#include "core/rays/hit.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

using Kind = Settlement::Kind;
constexpr double bound = 1e-6;
constexpr float e = 0x1p-22f; // 2.4e-7, well within the bound

// A square in z = 0 as two triangles that share the diagonal from (0,0) to (1,1); behind it, at z = -1, a larger one.
const TriangleMesh squares{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-4, -4, -1}, {8, -4, -1}, {-4, 8, -1}},
                           {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}};
constexpr std::uint32_t lower = 0, upper = 1, behind = 2;

Settlement settle(float x, float y, std::uint32_t ours, std::uint32_t reference)
{
    return Settler(squares).settle({{x, y, 1}, {0, 0, -1}}, ours, reference, bound);
}

} // namespace

TEST(Settle, the_exact_nearest_triangle_is_right_whatever_the_reference_says)
{
    EXPECT_EQ(settle(0.75f, 0.25f, lower, upper).kind, Kind::ours);
    EXPECT_EQ(settle(0.75f, 0.25f, lower, behind).kind, Kind::ours);
    EXPECT_EQ(settle(0.75f, 0.25f, lower, NO_HIT).kind, Kind::ours);
    EXPECT_EQ(settle(-1, -1, behind, lower).kind, Kind::ours);
}

TEST(Settle, either_side_of_a_shared_edge_is_a_tie_within_the_bound)
{
    EXPECT_EQ(settle(0.5f + e, 0.5f, upper, lower).kind, Kind::tie);
    EXPECT_NEAR(settle(0.5f + e, 0.5f, upper, lower).distance, 0x1p-22 / 1.41421356, 1e-12);
}

TEST(Settle, beyond_the_bound_the_wrong_side_of_a_shared_edge_is_wrong)
{
    EXPECT_EQ(settle(0.5f + 0x1p-18f, 0.5f, upper, lower).kind, Kind::wrong);
    EXPECT_EQ(settle(0.75f, 0.25f, upper, lower).kind, Kind::wrong);
}

TEST(Settle, slipping_past_a_silhouette_is_a_tie)
{
    EXPECT_EQ(settle(1 - e, 0.5f, behind, lower).kind, Kind::tie);
    EXPECT_EQ(settle(1 + e, 0.5f, lower, behind).kind, Kind::tie);
    EXPECT_EQ(settle(1 - 0x1p-18f, 0.5f, behind, lower).kind, Kind::wrong);
}

TEST(Settle, slipping_between_two_triangles_that_continue_each_other_is_wrong)
{
    EXPECT_EQ(settle(0.5f, 0.5f, behind, lower).kind, Kind::wrong) << "on the shared edge itself";
    EXPECT_EQ(settle(0.5f + e, 0.5f, NO_HIT, upper).kind, Kind::wrong);
}

TEST(Settle, a_miss_past_a_silhouette_is_a_tie_and_through_a_triangle_is_wrong)
{
    const TriangleMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Settler settler(one);
    const auto at = [&](float x, float y) { return settler.settle({{x, y, 1}, {0, 0, -1}}, NO_HIT, 0, bound).kind; };
    EXPECT_EQ(at(0.25f, e), Kind::tie);
    EXPECT_EQ(at(0.25f, 0.25f), Kind::wrong);
    EXPECT_EQ(at(0.25f, -e), Kind::ours);
}

TEST(Settle, a_fold_is_a_silhouette)
{
    // Two triangles on one edge, both to its left as seen from above.
    const TriangleMesh fold{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 0, -1}}, {{0, 1, 2}, {0, 1, 3}}};
    const Settler settler(fold);
    EXPECT_EQ(settler.settle({{-e, 0.25f, 1}, {0, 0, -1}}, NO_HIT, 0, bound).kind, Kind::tie);
    EXPECT_EQ(settler.settle({{-0.25f, 0.25f, 1}, {0, 0, -1}}, 1, 0, bound).kind, Kind::wrong)
        << "it hides the lower one";
}
