#include "bench/report/charts/axis.h"
#include "bench/report/charts/bar_chart.h"
#include "bench/report/charts/line_chart.h"
#include "bench/report/charts/roofline_chart.h"
#include "bench/report/html/svg.h"
#include "tests/output/report_fixture.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <random>
#include <regex>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The value of an attribute in each element of a class.
std::vector<double> attribute_of(const std::string& drawing, const std::string& css_class, const std::string& name)
{
    std::vector<double> values;
    const std::regex element("class=\"" + css_class + "\"[^>]* " + name + "=\"([-0-9.]+)\"");
    for (auto it = std::sregex_iterator(drawing.begin(), drawing.end(), element); it != std::sregex_iterator(); ++it)
        values.push_back(std::stod((*it)[1]));
    return values;
}

/// The points of the first path that only carries marks.
std::size_t carried_points(const std::string& drawing)
{
    std::smatch path;
    if (!std::regex_search(drawing, path, std::regex("class=\"carrier\"[^>]* d=\"([^\"]*)\""))) return 0;
    const std::string commands = path[1];
    return static_cast<std::size_t>(
        std::ranges::count_if(commands, [](char c) { return c == 'M' || c == 'L' || c == 'H'; }));
}

Bar bar_of(double value)
{
    return {"id", "a row", "", 0, value, {}, {}, {}, ""};
}

} // namespace

TEST(Axis, linear_ticks_are_round_and_enclose_the_values)
{
    EXPECT_EQ(Axis::linear(0, 39.15, 4).ticks(), (std::vector<double>{0, 10, 20, 30, 40}));
    EXPECT_EQ(Axis::linear(-3, 7, 5).ticks(), (std::vector<double>{-4, -2, 0, 2, 4, 6, 8}));
    EXPECT_EQ(Axis::linear(9.2, 21.7, 5).ticks(), (std::vector<double>{5, 10, 15, 20, 25}));
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const double low = std::pow(10.0, std::uniform_real_distribution(-12.0, 12.0)(random));
        const double high = low * std::uniform_real_distribution(1.0, 50.0)(random);
        const Axis axis = Axis::linear(low, high, 5);
        EXPECT_LE(axis.low(), low * (1 + 1e-6));
        EXPECT_GE(axis.high(), high * (1 - 1e-6));
        EXPECT_GE(axis.ticks().size(), 2u);
        EXPECT_LE(axis.ticks().size(), 9u);
        EXPECT_TRUE(std::is_sorted(axis.ticks().begin(), axis.ticks().end()));
    }
}

TEST(Axis, one_value_still_has_room)
{
    for (const double value : {0.0, 5.0, -5.0, 1e-12, 1e15}) {
        const Axis axis = Axis::linear(value, value);
        EXPECT_LT(axis.low(), axis.high()) << value;
        EXPECT_LE(axis.low(), value);
        EXPECT_GE(axis.high(), value);
        EXPECT_LT(axis.ticks().size(), 12u);
    }
    EXPECT_LT(Axis::linear(1, std::nextafter(1.0, 2.0)).ticks().size(), 12u);
}

TEST(Axis, logarithmic_ticks_are_powers_of_ten_or_finer)
{
    EXPECT_EQ(Axis::logarithmic(0.8, 1.5).ticks(), (std::vector<double>{0.5, 1, 2}));
    EXPECT_EQ(Axis::logarithmic(1, 1).ticks(), (std::vector<double>{1, 2}));
    EXPECT_EQ(Axis::logarithmic(30, 70).ticks(), (std::vector<double>{20, 50, 100}));
    EXPECT_EQ(Axis::logarithmic(3, 200'000).ticks(), (std::vector<double>{1, 10, 100, 1000, 10000, 100000, 1000000}));
    EXPECT_EQ(Axis::logarithmic(10, 1000).low(), 10);
    EXPECT_EQ(Axis::logarithmic(10, 1000).high(), 1000);
}

TEST(Axis, places_values_linearly_or_by_their_logarithm)
{
    const Axis linear = Axis::linear(0, 40, 4);
    EXPECT_DOUBLE_EQ(linear.place(10, 100, 200), 125);
    EXPECT_DOUBLE_EQ(linear.place(10, 200, 100), 175);
    EXPECT_DOUBLE_EQ(linear.place(99, 100, 200), 200) << "past the axis: at its end";
    const Axis logarithmic = Axis::logarithmic(1, 100'000);
    EXPECT_NEAR(logarithmic.place(10, 0, 100), 20, 1e-9);
    EXPECT_NEAR(logarithmic.place(1000, 0, 100), 60, 1e-9);
}

TEST(Axis, of_bars_ends_with_the_longest)
{
    const Axis axis = Axis::from_zero(39.15);
    EXPECT_EQ(axis.high(), 39.15);
    EXPECT_EQ(axis.ticks(), (std::vector<double>{0, 10, 20, 30}));
    EXPECT_EQ(Axis::from_zero(40).ticks().back(), 40);
    EXPECT_GT(Axis::from_zero(0).high(), 0);
    EXPECT_THROW(static_cast<void>(Axis::from_zero(-1)), Error);
}

TEST(Axis, with_ticks_at_values_has_each_once_and_a_margin)
{
    const Axis axis = Axis::logarithmic_at({64, 44, 64}, 1.5);
    EXPECT_EQ(axis.ticks(), (std::vector<double>{44, 64}));
    EXPECT_DOUBLE_EQ(axis.low(), 44 / 1.5);
    EXPECT_DOUBLE_EQ(axis.high(), 96);
    EXPECT_EQ(Axis::logarithmic_at({44}, 1.5).label(44), "44");
    EXPECT_THROW(static_cast<void>(Axis::logarithmic_at({}, 1.5)), Error);
    EXPECT_THROW(static_cast<void>(Axis::logarithmic_at({0, 1}, 1.5)), Error);
}

TEST(Axis, what_is_not_finite_is_no_range_and_has_no_place)
{
    const double nan = std::nan("");
    for (const auto& [low, high] : std::vector<std::pair<double, double>>{
             {nan, 1}, {0, nan}, {0, infinity}, {-infinity, 0}, {2, 1}, {-1.7e308, 1.7e308}})
        EXPECT_THROW(static_cast<void>(Axis::linear(low, high)), Error) << low << " " << high;
    EXPECT_THROW(static_cast<void>(Axis::logarithmic(0, 1)), Error);
    EXPECT_THROW(static_cast<void>(Axis::logarithmic(-1, 1)), Error);
    EXPECT_THROW(static_cast<void>(Axis::linear(0, 1).place(nan, 0, 1)), Error);
    BarChart chart{"a chart", "Mrays/s", {bar_of(nan)}};
    EXPECT_THROW(static_cast<void>(draw(chart)), Error);
}

TEST(Axis, labels_have_the_decimals_of_the_step)
{
    const Axis axis = Axis::linear(0, 1, 4);
    EXPECT_EQ(axis.label(0.5), "0.5");
    EXPECT_EQ(axis.label(0), "0.0");
    EXPECT_EQ(Axis::linear(0, 100000, 4).label(50000), "50,000");
    EXPECT_EQ(Axis::linear(-3, 7).label(-2), "-2");
    EXPECT_EQ(Axis::logarithmic(0.01, 10).label(0.05), "0.05");
}

TEST(ShortNumber, has_three_digits_and_loses_none_before_the_point)
{
    const std::vector<std::pair<double, const char*>> cases = {
        {0, "0"},          {5.1, "5.10"},       {22.97, "23.0"}, {146.4, "146"}, {1234.4, "1,234"}, {0.01234, "0.0123"},
        {-22.97, "-23.0"}, {303000, "303,000"}, {1e-9, "1e-09"}, {1e18, "1e+18"}};
    for (const auto& [value, text] : cases)
        EXPECT_EQ(short_number(value), text);
    EXPECT_EQ(fixed_number(9, 0), "9");
    EXPECT_EQ(fixed_number(0, 1), "0");
    EXPECT_EQ(fixed_number(1282, 0), "1,282");
    EXPECT_EQ(fixed_number(-4.25, 1), "-4.2");
    EXPECT_EQ(fixed_number(0.1, 1), "0.1");
    EXPECT_EQ(fixed_number(0.04, 1), "0.0400") << "not 0.0";
    EXPECT_EQ(fixed_number(0.3, 0), "0.300");
    EXPECT_EQ(fixed_number(1e20, 0), "1e+20");
    EXPECT_EQ(short_percent(0.081), "8.1 %");
    EXPECT_EQ(short_percent(0.0999), "10 %");
    EXPECT_EQ(short_percent(1.35), "135 %");
}

TEST(SpreadApart, keeps_order_and_distance_and_moves_nothing_without_need)
{
    EXPECT_EQ(spread_apart({10, 50, 90}, 17, 0, 100), (std::vector<double>{10, 50, 90}));
    EXPECT_EQ(spread_apart({50, 50}, 10, 0, 100), (std::vector<double>{45, 55}));
    EXPECT_EQ(spread_apart({52, 50, 90}, 10, 0, 100), (std::vector<double>{56, 46, 90}));
    EXPECT_EQ(spread_apart({0, 0, 0}, 10, 0, 100), (std::vector<double>{0, 10, 20}));
    EXPECT_EQ(spread_apart({100, 100}, 10, 0, 100), (std::vector<double>{90, 100}));
    EXPECT_TRUE(spread_apart({}, 10, 0, 100).empty());
}

TEST(SpreadApart, never_overlaps)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(0, 400);
    for (int run = 0; run < 200; ++run) {
        std::vector<double> wanted(static_cast<std::size_t>(run % 20 + 1));
        std::generate(wanted.begin(), wanted.end(), [&] { return place(random); });
        auto placed = spread_apart(wanted, 17, 0, 400);
        std::sort(placed.begin(), placed.end());
        for (std::size_t i = 1; i < placed.size(); ++i)
            EXPECT_GE(placed[i] - placed[i - 1], 17 - 1e-9);
        EXPECT_GE(placed.front(), 0);
        EXPECT_LE(placed.back(), 400);
    }
}

TEST(BarChart, bars_are_as_long_as_their_values)
{
    BarChart chart{"a chart", "Mrays/s", {bar_of(40), bar_of(10), bar_of(20)}};
    const auto widths = attribute_of(draw(chart).str(), "bar", "width");
    ASSERT_EQ(widths.size(), 3u);
    EXPECT_NEAR(widths[1] / widths[0], 0.25, 0.01);
    EXPECT_NEAR(widths[2] / widths[0], 0.5, 0.01);
}

TEST(BarChart, has_a_mark_per_bar_a_tick_per_sample_and_a_whisker_if_there_is_a_spread)
{
    BarChart chart{"a chart", "Mrays/s", {bar_of(40), bar_of(10)}};
    chart.bars[0].samples = {39, 40, 44};
    chart.bars[0].low = 39.5;
    chart.bars[0].high = 42;
    chart.bars[1].note = "3 wrong, noisy";
    const std::string drawing = draw(chart).str();
    EXPECT_EQ(occurrences(drawing, "class=\"mark "), 2u);
    EXPECT_EQ(carried_points(drawing), 3u) << "samples";
    EXPECT_EQ(occurrences(drawing, "class=\"whisker\""), 3u) << "a line with two ends";
    EXPECT_TRUE(contains(drawing, ">3 wrong, noisy</text>"));
    EXPECT_TRUE(contains(drawing, "40.0</text>"));
}

TEST(BarChart, nothing_is_drawn_outside_the_drawing)
{
    BarChart chart{"a chart", "Mrays/s", {bar_of(1e-15), bar_of(123456789)}};
    chart.bars[0].label = std::string(300, 'W');
    chart.bars[1].note = "a note of a length that does not fit in the drawing";
    chart.bars[1].samples = {2e8};
    const std::string drawing = draw(chart).str();
    for (const double x : attribute_of(drawing, "value", "x")) {
        EXPECT_GE(x, 0);
        EXPECT_LE(x + 100, chart_width);
    }
    EXPECT_TRUE(contains(drawing, ">123,456,789</text>")) << "the value itself is never cut";
    for (const double x : attribute_of(drawing, "label end", "x"))
        EXPECT_LT(x, chart_width / 2);
    EXPECT_TRUE(contains(drawing, "WWW…</text>"));
}

TEST(BarChart, names_of_rows_stand_there_whole_in_several_lines_where_one_is_too_short)
{
    BarChart chart{"a chart", "Mrays/s", {bar_of(40), bar_of(10)}};
    const auto short_names = attribute_of(draw(chart).str(), "bar", "y");
    chart.bars[0].label = "cdt project half32 fast reached persistent shuffled  vulkan:1";
    chart.bars[0].sublabel = "NVIDIA GeForce RTX 4090 Laptop GPU with a long name · A";
    const std::string drawing = draw(chart).str();
    EXPECT_EQ(drawing.find("…"), std::string::npos);
    for (const char* const word : {"cdt project", "persistent", "vulkan:1</text>", "Laptop", "A</text>"})
        EXPECT_TRUE(contains(drawing, word)) << word;
    const auto long_names = attribute_of(drawing, "bar", "y");
    EXPECT_GT(long_names[1] - long_names[0], short_names[1] - short_names[0]) << "rows keep clear of each other";
}

TEST(IntervalChart, close_ratios_fill_a_linear_axis)
{
    IntervalChart chart{
        "ratios", "slower", "faster", {{"a", "a", "", 0, 0.98, 0.97, 0.99}, {"b", "b", "", 1, 1, 0.99, 1.01}}};
    const auto begins = attribute_of(draw(chart).str(), "interval", "x1");
    const auto ends = attribute_of(draw(chart).str(), "interval", "x2");
    ASSERT_EQ(begins.size(), 2u);
    EXPECT_GT(ends[0] - begins[0], 40) << "two of four hundredths that are drawn";
}

TEST(IntervalChart, an_interval_that_holds_one_is_hollow)
{
    IntervalChart chart{
        "ratios", "slower", "faster", {{"a", "a", "", 0, 1.2, 0.9, 1.5}, {"b", "b", "", 1, 2, 1.5, 2.5}}};
    const std::string drawing = draw(chart).str();
    EXPECT_EQ(occurrences(drawing, "class=\"hollow\""), 1u);
    EXPECT_EQ(occurrences(drawing, "class=\"solid\""), 1u);
    EXPECT_EQ(occurrences(drawing, "class=\"reference\""), 1u);
    EXPECT_TRUE(contains(drawing, "1.20 [0.90, 1.50]"));
}

TEST(Roofline, ceiling_and_share_are_those_of_the_copy_bandwidth)
{
    Roofline roofline{"a device", 12.8e9, {{"a", "maria tet96", 0, 64, 50}}};
    EXPECT_DOUBLE_EQ(roofline.ceiling(64), 200) << "12.8e9 bytes per second, 64 bytes per step";
    EXPECT_DOUBLE_EQ(roofline.share(roofline.points[0]), 0.25);
    EXPECT_TRUE(contains(draw(roofline).str(), "25 %  maria tet96</text>"));
    EXPECT_TRUE(contains(draw(roofline).str(), "12.8 GB/s"));
}

TEST(Roofline, a_point_below_the_ceiling_is_drawn_below_the_line_and_one_above_above_it)
{
    for (const double rate : {50.0, 400.0}) {
        const Roofline roofline{"a device", 12.8e9, {{"a", "maria tet96", 0, 64, rate}}};
        const std::string drawing = draw(roofline).str();
        const double x1 = attribute_of(drawing, "roof", "x1").at(0), x2 = attribute_of(drawing, "roof", "x2").at(0);
        const double y1 = attribute_of(drawing, "roof", "y1").at(0), y2 = attribute_of(drawing, "roof", "y2").at(0);
        std::smatch point;
        ASSERT_TRUE(std::regex_search(drawing, point, std::regex("class=\"solid\" d=\"M([0-9.]+) ([0-9.]+)m")));
        const double x = std::stod(point[1]), y = std::stod(point[2]);
        const double roof_y = y1 + (x - x1) / (x2 - x1) * (y2 - y1);
        EXPECT_EQ(y > roof_y, rate < roofline.ceiling(64)) << rate;
    }
}

TEST(Roofline, has_a_line_for_each_level_of_memory_that_holds_a_scene)
{
    const Roofline roofline{
        "a device",
        12.8e9,
        {{"a", "in memory", 0, 64, 50}, {"b", "in a cache", 0, 64, 50, 128e9}, {"c", "too", 0, 32, 50, 128e9}}};
    EXPECT_EQ(roofline.bandwidths(), (std::vector<double>{12.8e9, 128e9}));
    EXPECT_DOUBLE_EQ(roofline.share(roofline.points[0]), 0.25);
    EXPECT_DOUBLE_EQ(roofline.share(roofline.points[1]), 0.025);
    const std::string drawing = draw(roofline).str();
    EXPECT_EQ(attribute_of(drawing, "roof", "y1").size(), 2u);
    EXPECT_TRUE(contains(drawing, "128 GB/s") && contains(drawing, "12.8 GB/s"));
}

TEST(Roofline, has_a_mark_a_point_however_many)
{
    Roofline roofline{"a device", 1e10, {}};
    for (int i = 0; i < 60; ++i)
        roofline.points.push_back({"id", "maria tet80  bunny", 0, 44, 50});
    const std::string drawing = draw(roofline).str();
    EXPECT_EQ(occurrences(drawing, "class=\"mark "), 60u);
    auto labels = attribute_of(drawing, "label", "y");
    ASSERT_EQ(labels.size(), 61u) << "the roof has one too";
    std::sort(labels.begin(), labels.end());
    for (std::size_t i = 1; i < labels.size(); ++i)
        EXPECT_GE(labels[i] - labels[i - 1], 13) << "labels overlap";
}

TEST(LineChart, ascending_x_make_a_line_and_others_a_cloud)
{
    LineChart chart{
        "a figure", "view", "time, ms", {{"time", {{0, 1}, {1, 2}, {2, 3}}}, {"scatter", {{2, 1}, {1, 2}}}}};
    const std::string drawing = draw(chart).str();
    EXPECT_EQ(occurrences(drawing, "class=\"line\""), 1u);
    EXPECT_EQ(carried_points(drawing), 2u) << "of the cloud";
    EXPECT_EQ(occurrences(drawing, "url(#cloud1)"), 3u) << "a mark at its first, its middle and its last points";
    EXPECT_EQ(occurrences(drawing, "class=\"mark "), 2u);
    EXPECT_TRUE(contains(drawing, "time, ms"));
}

TEST(Axis, of_dates_has_ticks_at_whole_days_or_hours)
{
    const double day = 20'778; // 2026-11-21
    const Axis days = Axis::dates(day + 0.73, day + 2.1);
    EXPECT_EQ(days.label(day), "11-21 00:00") << "half days";
    const Axis weeks = Axis::dates(day, day + 20);
    EXPECT_EQ(weeks.ticks()[1] - weeks.ticks()[0], 7);
    EXPECT_EQ(weeks.label(day), "2026-11-21");
    EXPECT_LE(weeks.low(), day);
    EXPECT_GE(weeks.high(), day + 20);
    for (const double range : {0.0, 0.01, 0.2, 1.0, 3.0, 40.0, 700.0, 40'000.0}) {
        const Axis axis = Axis::dates(day + 0.3, day + 0.3 + range);
        EXPECT_GE(axis.ticks().size(), 2u) << range;
        EXPECT_LE(axis.ticks().size(), 9u) << range;
        std::set<std::string> labels;
        for (const double tick : axis.ticks())
            EXPECT_TRUE(labels.insert(axis.label(tick)).second) << range << ": " << axis.label(tick);
    }
}

TEST(LineChart, takes_one_point_empty_series_and_thousands)
{
    LineChart chart{"a figure", "x", "y", {{"one", {{3, 4}}}, {"none", {}}}};
    EXPECT_EQ(occurrences(draw(chart).str(), "class=\"mark "), 1u);
    for (int i = 0; i < 1282; ++i)
        chart.series[1].points.emplace_back(i, 1e6 + i);
    const std::string drawing = draw(chart).str();
    EXPECT_EQ(occurrences(drawing, "class=\"mark "), 2u);
    EXPECT_LT(drawing.size(), 60'000u) << "most of a long line's points are without marks";
}

TEST(LineChart, a_power_law_is_a_straight_line_between_logarithmic_axes)
{
    LineChart chart{"a figure", "faces", "ns per ray", {{"bvh2", {{1e2, 1e0}, {1e3, 1e1}, {1e4, 1e2}}}}, true, true};
    const std::string drawing = draw(chart).str();
    std::smatch path;
    ASSERT_TRUE(
        std::regex_search(drawing, path, std::regex("M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)")));
    const auto at = [&](std::size_t i) { return std::stod(path[i]); };
    EXPECT_NEAR(at(3) - at(1), at(5) - at(3), 0.21);
    EXPECT_NEAR(at(4) - at(2), at(6) - at(4), 0.21);
    EXPECT_LT(at(6), at(2)) << "upwards";
}

TEST(LineChart, every_label_of_twenty_series_lies_within_the_drawing)
{
    LineChart chart{"a figure", "tets", "time, ms", {}};
    for (int i = 0; i < 20; ++i)
        chart.series.push_back({fmt::format("method {}", i), {{20, 5}, {10, 1}}});
    const std::string drawing = draw(chart).str();
    auto labels = attribute_of(drawing, "label", "y");
    ASSERT_EQ(labels.size(), 20u);
    std::sort(labels.begin(), labels.end());
    for (std::size_t i = 1; i < labels.size(); ++i)
        EXPECT_GE(labels[i] - labels[i - 1], 13) << "labels overlap";
    std::smatch height;
    ASSERT_TRUE(std::regex_search(drawing, height, std::regex("viewBox=\"0 0 [0-9.]+ ([0-9.]+)\"")));
    EXPECT_GT(labels.front(), 13);
    EXPECT_LT(labels.back(), std::stod(height[1]));
}
