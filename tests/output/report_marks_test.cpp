// Series are distinguished by colour, shape and dash; points that share a path share a definition of their mark.
#include "bench/report/charts/line_chart.h"
#include "bench/report/html/svg.h"
#include "tests/output/report_fixture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

} // namespace

TEST(Series, have_marks_that_all_differ_up_to_their_number)
{
    std::set<std::string> marks, lines;
    for (std::size_t i = 0; i < series_marks; ++i) {
        marks.insert(series_class(i) + svg_shape(0, 0, i, "solid").str());
        if (i < series_marks / 2) lines.insert(series_class(i));
    }
    EXPECT_EQ(marks.size(), series_marks);
    EXPECT_EQ(lines.size(), series_marks / 2) << "colour and dash distinguish lines without a shape";
    EXPECT_EQ(series_class(series_marks), series_class(0));
}

TEST(Series, that_share_a_colour_in_a_chart_differ_in_shape_and_dash)
{
    LineChart chart{"a figure", "x", "y", {}};
    for (int i = 0; i < 20; ++i)
        chart.series.push_back({fmt::format("method {}", i), {{10, 1}, {20, 5}}});
    const std::string drawing = draw(chart).str();
    std::set<std::string> classes;
    const std::regex mark("class=\"mark ([^\"]*)\"");
    for (auto it = std::sregex_iterator(drawing.begin(), drawing.end(), mark); it != std::sregex_iterator(); ++it)
        classes.insert((*it)[1]);
    EXPECT_EQ(classes.size(), 20u);
    EXPECT_EQ(occurrences(drawing, "class=\"solid\""), 60u) << "two points, and the shape before the name";
}

TEST(MarkDefinitions, are_those_that_the_markup_refers_to_once_each)
{
    const Html clouds = svg_cloud({{1, 2}, {3, 4}}, 0) + svg_cloud({{1, 2}}, 9) + svg_cloud({{5, 6}}, 9);
    const std::string marks = mark_definitions(clouds).str();
    EXPECT_EQ(occurrences(marks, "<marker "), 2u);
    EXPECT_EQ(occurrences(marks, "id=\"cloud0\""), 1u);
    EXPECT_EQ(occurrences(marks, "id=\"cloud9\" class=\"s2 d3\""), 1u);
    EXPECT_EQ(occurrences(mark_definitions(svg_samples({1, 2}, 3)).str(), "id=\"sample\""), 1u);
    EXPECT_TRUE(mark_definitions(text("none")).empty());
}

TEST(LineChart, marks_every_point_of_a_short_line_and_some_of_a_long_one)
{
    LineChart chart{"a figure", "x", "y", {{"line", {}}}};
    const auto marks_of = [&](int points) {
        chart.series[0].points.clear();
        for (int i = 0; i < points; ++i)
            chart.series[0].points.emplace_back(i, i);
        return occurrences(draw(chart).str(), "class=\"solid\"") - 1; // one is before the name
    };
    EXPECT_EQ(marks_of(24), 24u);
    for (const int points : {25, 100, 1282}) {
        EXPECT_GE(marks_of(points), 8u) << points;
        EXPECT_LE(marks_of(points), 9u) << points;
    }
}
