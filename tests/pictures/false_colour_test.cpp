#include "bench/pictures/false_colour.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace tetrace;

namespace {

struct Lab {
    double lightness, a, b;
};

/// Linear sRGB to OKLab, with the forward matrices of Ottosson's article (the picture uses the inverse ones).
Lab to_oklab(Colour c)
{
    const double l = std::cbrt(0.4122214708 * c.r + 0.5363325363 * c.g + 0.0514459929 * c.b);
    const double m = std::cbrt(0.2119034982 * c.r + 0.6806995451 * c.g + 0.1073969566 * c.b);
    const double s = std::cbrt(0.0883024619 * c.r + 0.2817188376 * c.g + 0.6299787005 * c.b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double distance(Lab a, Lab b)
{
    return std::hypot(a.lightness - b.lightness, a.a - b.a, a.b - b.b);
}

Hit hit_after(std::uint32_t steps)
{
    return {0, 0, 1.0f, 0.0f, 0.0f, steps};
}

bool has_pixel(const Pixmap& pixmap, Colour colour)
{
    return std::find(pixmap.pixels.begin(), pixmap.pixels.end(), colour) != pixmap.pixels.end();
}

} // namespace

// Floats hold colours to 1e-7 and the matrices are printed to 1e-10: 1e-3 of the range is far above both.
TEST(FalseColour, lightness_rises_evenly)
{
    const double first = to_oklab(false_colour(0.0)).lightness, last = to_oklab(false_colour(1.0)).lightness;
    ASSERT_GT(last - first, 0.6);
    for (int i = 0; i <= 100; ++i) {
        const double even = first + (last - first) * i / 100.0;
        EXPECT_NEAR(to_oklab(false_colour(i / 100.0)).lightness, even, 1e-3) << "at " << i << " %";
    }
}

TEST(FalseColour, equal_differences_look_equal)
{
    double least = 1e9, most = 0;
    for (int i = 0; i < 100; ++i) {
        const double step = distance(to_oklab(false_colour(i / 100.0)), to_oklab(false_colour((i + 1) / 100.0)));
        least = std::min(least, step);
        most = std::max(most, step);
    }
    EXPECT_LT(most / least, 1.15);
}

TEST(FalseColour, values_outside_are_clamped)
{
    EXPECT_EQ(false_colour(-3.0), false_colour(0.0));
    EXPECT_EQ(false_colour(7.0), false_colour(1.0));
}

TEST(ScaleTicks, are_few_round_and_within)
{
    for (const std::uint32_t top : {1u, 2u, 6u, 7u, 10u, 63u, 64u, 99u, 100u, 1000u, 12345u, 4294967295u}) {
        const auto ticks = scale_ticks(top);
        EXPECT_GE(ticks.size(), 2u) << top;
        EXPECT_LE(ticks.size(), 7u) << top;
        EXPECT_LE(ticks.back(), top);
        EXPECT_GT(std::uint64_t{ticks.back()} + ticks[1], top) << "one more tick would fit under " << top;
        std::uint32_t lead = ticks[1];
        while (lead >= 10) {
            EXPECT_EQ(lead % 10, 0u) << top;
            lead /= 10;
        }
        EXPECT_TRUE(lead == 1 || lead == 2 || lead == 5) << ticks[1];
    }
    EXPECT_EQ(scale_ticks(63), (std::vector<std::uint32_t>{0, 10, 20, 30, 40, 50, 60}));
}

TEST(SummarizeSteps, lost_rays_count_apart)
{
    const std::vector<Hit> hits{hit_after(1), hit_after(3), {NO_HIT, NO_TET, 0, 0, 0, 5}, {LOST, 7, 0, 0, 0, 60000}};
    const StepSummary summary = summarize_steps(hits);
    EXPECT_EQ(summary.lost, 1u);
    EXPECT_EQ(summary.most, 5u);
    EXPECT_DOUBLE_EQ(summary.mean, 3.0);
}

TEST(SummarizeSteps, a_few_long_rays_do_not_stretch_the_scale)
{
    std::vector<Hit> hits(10000, hit_after(20));
    hits[1234].steps = 3000;
    EXPECT_EQ(summarize_steps(hits).top, 20u);
    EXPECT_EQ(summarize_steps(hits).most, 3000u);
}

TEST(SummarizeSteps, an_image_without_steps_has_a_scale)
{
    const std::vector<Hit> hits(4, Hit{NO_HIT, NO_TET, 0, 0, 0, 0});
    EXPECT_EQ(summarize_steps(hits).top, 1u);
    EXPECT_EQ(summarize_steps({}).top, 1u);
}

TEST(DrawSteps, pixels_are_those_of_the_rays)
{
    std::vector<Hit> hits(600 * 4, hit_after(10));
    hits[0].steps = 0;
    hits[1].steps = 5;
    hits[2].face_id = LOST;
    const Pixmap pixmap = draw_steps(hits, 600, 4, "cubes");
    ASSERT_GE(pixmap.width, 600u);
    EXPECT_EQ(pixmap.at(0, 0), Colour{});
    EXPECT_EQ(pixmap.at(1, 0), false_colour(0.5));
    EXPECT_EQ(pixmap.at(2, 0), lost_colour());
    EXPECT_EQ(pixmap.at(599, 3), false_colour(1.0));
}

TEST(DrawSteps, has_a_bar_from_end_to_end_below_the_picture)
{
    std::vector<Hit> hits(600 * 4, hit_after(10));
    Pixmap footer = draw_steps(hits, 600, 4, "cubes");
    footer.pixels.erase(footer.pixels.begin(), footer.pixels.begin() + footer.width * 4);
    EXPECT_TRUE(has_pixel(footer, false_colour(0.0)));
    EXPECT_TRUE(has_pixel(footer, false_colour(1.0)));
    EXPECT_TRUE(has_pixel(footer, from_srgb(0xE8EAED))) << "no lettering";
    EXPECT_FALSE(has_pixel(footer, lost_colour()));
}

TEST(DrawSteps, pictures_side_by_side_have_one_scale)
{
    const std::vector<StepsImage> images = {{std::vector<Hit>(600 * 4, hit_after(10)), "cdt"},
                                            {std::vector<Hit>(600 * 4, hit_after(5)), "rays"}};
    const Pixmap pixmap = draw_steps(images, 600, 4);
    EXPECT_EQ(pixmap.at(0, 0), false_colour(1.0));
    EXPECT_EQ(pixmap.at(pixmap.width / 2, 0), false_colour(0.5)) << "5 of 10 steps";
    EXPECT_EQ(pixmap.height, draw_steps(images[0].hits, 600, 4, "cdt").height);
    EXPECT_GE(pixmap.width, 1200u);
}

TEST(DrawSteps, a_tiny_picture_is_widened_for_its_title)
{
    const std::vector<Hit> hits(2 * 2, hit_after(1));
    EXPECT_GT(draw_steps(hits, 2, 2, "cubes").width, 200u);
}
