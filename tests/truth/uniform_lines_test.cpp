// Lengths of uniform lines, by a law of integral geometry.
#include "bench/truth/uniform_lines.h"
#include "scenes/procedural.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/given_scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::uint32_t seeds = 48;

/// Uniform lines through the cubes. size: of the image for whose pixels they are made.
class LinesThroughScene {
public:
    LinesThroughScene(std::uint32_t resolution, std::uint32_t size)
        : given_(size, false, resolution), tets_(given_.scene, Method::project, Layout::half32)
    {
    }

    [[nodiscard]] std::vector<CrossedTets> walks(RayKind kind, std::uint32_t seed = 0) const
    {
        return tets_.walks(make_rays(kind, given_.source(seed)));
    }
    [[nodiscard]] LineTest tested(const std::vector<CrossedTets>& walks) const
    {
        UniformLines lines(given_.scene, tets_.mesh_of_packed());
        for (const CrossedTets& walk : walks)
            lines.add(walk);
        return lines.test();
    }
    /// The tet that most walks cross, and one of its neighbours.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> most_crossed(const std::vector<CrossedTets>& walks) const
    {
        std::vector<std::size_t> crossings(tets_.mesh_of_packed().size());
        for (const CrossedTets& walk : walks)
            for (const std::uint32_t tet : walk.tets)
                ++crossings[tet];
        const auto most = static_cast<std::uint32_t>(std::ranges::max_element(crossings) - crossings.begin());
        for (const CrossedTets& walk : walks)
            for (std::size_t i = 1; i < walk.tets.size(); ++i)
                if (walk.tets[i] == most) return {most, walk.tets[i - 1]};
        return {most, most};
    }

private:
    GivenScene given_;
    CrossedScene tets_;
};

std::string text_of(const LineTest& test)
{
    const auto of_cells = [](const CellTest& cells) {
        return fmt::format("{} cells, {} testable, off {:.2f}, worst {:.3f}", cells.cells, cells.testable, cells.off,
                           cells.worst);
    };
    return fmt::format("{} lines, {} meetings, mean off {:.2f}; tets: {}; groups: {}", test.lines, test.meetings,
                       test.mean_off, of_cells(test.tets), of_cells(test.groups));
}

/// As if the lengths in these tets were too large, all by that share.
void stretch(CrossedTets& walk, double share, const std::function<bool(std::uint32_t)>& is_wrong)
{
    std::vector<std::uint32_t> more{0};
    for (std::size_t i = 0; i < walk.tets.size(); ++i) {
        const std::uint32_t begin = walk.places[i], end = std::max(begin, walk.places[i + 1]);
        more.push_back(more.back() + (is_wrong(walk.tets[i]) ? static_cast<std::uint32_t>(share * (end - begin)) : 0));
    }
    for (std::size_t i = 0; i < walk.places.size(); ++i)
        walk.places[i] += more[i];
}

struct Spread {
    double mean = 0, deviation = 0;
};

Spread spread_of(const std::vector<double>& values)
{
    Spread spread;
    for (const double value : values)
        spread.mean += value / static_cast<double>(values.size());
    for (const double value : values)
        spread.deviation += (value - spread.mean) * (value - spread.mean) / static_cast<double>(values.size() - 1);
    spread.deviation = std::sqrt(spread.deviation);
    return spread;
}

} // namespace

TEST(UniformLines, have_the_mean_length_of_integral_geometry_in_each_tet)
{
    const LinesThroughScene lines(6, 128);
    auto walks = lines.walks(RayKind::random);
    const LineTest right = lines.tested(walks);
    EXPECT_EQ(right.lines, 128u * 128);
    EXPECT_GT(right.tets.cells, 1000u);
    EXPECT_GT(right.groups.cells, 200u);
    EXPECT_TRUE(right.passes()) << text_of(right);
    EXPECT_NEAR(right.mean_length / right.expected_length, 1, 0.02);

    for (CrossedTets& walk : walks) // as if the last tet of each were left out
        if (walk.tets.size() > 1) {
            walk.tets.pop_back();
            walk.places.pop_back();
        }
    EXPECT_FALSE(lines.tested(walks).passes());
}

// Every second tet's lengths are those of the one before it in memory, its neighbour mostly, and of the same group.
TEST(UniformLines, show_a_tally_into_the_neighbours_cells)
{
    const LinesThroughScene lines(6, 64);
    auto walks = lines.walks(RayKind::random);
    EXPECT_TRUE(lines.tested(walks).passes());
    for (CrossedTets& walk : walks)
        for (std::uint32_t& tet : walk.tets)
            tet &= ~1u;
    const LineTest moved = lines.tested(walks);
    EXPECT_FALSE(moved.tets.passes()) << text_of(moved);
    fmt::print("into the tet before: {}\n", text_of(moved));
}

TEST(UniformLines, show_a_single_tet_whose_lengths_its_neighbour_has)
{
    const LinesThroughScene lines(3, 128);
    auto walks = lines.walks(RayKind::random);
    const auto [tet, neighbour] = lines.most_crossed(walks);
    ASSERT_NE(tet, neighbour);
    const LineTest right = lines.tested(walks);
    EXPECT_TRUE(right.passes()) << text_of(right);
    EXPECT_GT(right.tets.testable, right.tets.cells / 2);
    for (CrossedTets& walk : walks)
        std::ranges::replace(walk.tets, tet, neighbour);
    const LineTest moved = lines.tested(walks);
    EXPECT_GT(moved.tets.worst, 1) << text_of(moved);
}

TEST(UniformLines, show_a_single_tet_whose_lengths_are_five_percent_wrong)
{
    const LinesThroughScene lines(2, 768);
    auto walks = lines.walks(RayKind::random);
    const std::uint32_t tet = lines.most_crossed(walks).first;
    const LineTest right = lines.tested(walks);
    EXPECT_TRUE(right.passes()) << text_of(right);
    EXPECT_EQ(right.tets.testable, right.tets.cells);
    for (CrossedTets& walk : walks)
        stretch(walk, 0.05, [&](std::uint32_t crossed) { return crossed == tet; });
    const LineTest wrong = lines.tested(walks);
    EXPECT_GT(wrong.tets.worst, 1) << text_of(wrong);
    fmt::print("right: {}\n5 % more in a tet: {}\n", text_of(right), text_of(wrong));
}

// As many lines as the page has for each scene: in tets and in groups 5 % is within the noise.
TEST(UniformLines, show_in_the_domain_what_is_small_everywhere)
{
    const LinesThroughScene lines(9, 90);
    auto walks = lines.walks(RayKind::random);
    const LineTest right = lines.tested(walks);
    EXPECT_TRUE(right.passes()) << text_of(right);
    for (CrossedTets& walk : walks)
        stretch(walk, 0.05, [](std::uint32_t) { return true; });
    const LineTest wrong = lines.tested(walks);
    EXPECT_FALSE(wrong.passes()) << text_of(wrong);
    EXPECT_GT(wrong.mean_off, 6) << text_of(wrong);
    fmt::print("5 % more everywhere: {}\n", text_of(wrong));
}

// A tenth more in half of the domain: tets by themselves have the noise of few crossings each.
TEST(UniformLines, show_in_groups_what_is_small_in_each_tet)
{
    const LinesThroughScene lines(12, 128);
    auto walks = lines.walks(RayKind::random);
    const std::size_t half = lines.tested(walks).tets.cells / 2;
    for (CrossedTets& walk : walks)
        stretch(walk, 0.1, [&](std::uint32_t tet) { return tet < half; });
    const LineTest wrong = lines.tested(walks);
    EXPECT_FALSE(wrong.groups.passes()) << text_of(wrong);
    EXPECT_GT(2 * wrong.groups.off, 3 * wrong.tets.off) << text_of(wrong);
    fmt::print("10 % more in half of the domain: {}\n", text_of(wrong));
}

// The null distribution, by lines of many seeds, when tets expect a few crossings each and when they expect many.
TEST(UniformLines, are_off_by_one_standard_deviation_whatever_the_number_of_crossings)
{
    for (const auto& [resolution, size] : {std::pair{9u, 24u}, std::pair{6u, 32u}, std::pair{2u, 32u}}) {
        const LinesThroughScene lines(resolution, size);
        std::vector<double> domain, tets, groups;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            const LineTest test = lines.tested(lines.walks(RayKind::random, seed));
            EXPECT_TRUE(test.passes()) << text_of(test);
            domain.push_back(test.mean_off);
            tets.push_back(test.tets.off);
            groups.push_back(test.groups.off);
        }
        for (const auto* const off : {&domain, &tets, &groups}) {
            const auto [mean, deviation] = spread_of(*off);
            EXPECT_NEAR(mean, 0, 5 / std::sqrt(seeds)) << resolution;
            EXPECT_NEAR(deviation, 1, 0.28) << resolution; // half or twice the variance is 0.71 or 1.41
            fmt::print("{} cubes per axis, {} lines: mean {:.2f}, deviation {:.2f}, largest {:.2f}\n", resolution,
                       size * size, mean, deviation, std::ranges::max(*off));
        }
    }
}

TEST(UniformLines, other_rays_do_not_have_it)
{
    const LinesThroughScene lines(6, 64);
    EXPECT_FALSE(lines.tested(lines.walks(RayKind::primary)).passes());
}

TEST(UniformLines, are_not_judged_if_they_are_few)
{
    const LinesThroughScene lines(6, 8);
    const LineTest few = lines.tested(lines.walks(RayKind::random));
    EXPECT_EQ(few.lines, 64u);
    EXPECT_FALSE(few.is_testable());
    EXPECT_FALSE(few.passes());
    EXPECT_TRUE(std::isfinite(few.tets.off) && std::isfinite(few.groups.off));
    const LineTest none = lines.tested({});
    EXPECT_FALSE(none.is_testable());
    EXPECT_EQ(none.mean_length, 0);
}
