// The charts of a page as SVG files of their own.
#include "bench/report/standalone.h"
#include "tests/output/report_fixture.h"

#include <cstdlib>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;

TEST_F(ReportPage, charts_are_well_formed_files_that_need_nothing_else)
{
    json reproduced = reproduce_json(hostile);
    reproduced["tetrace"]["figures"][0]["series"] = {{{"name", "a"}, {"points", {{2, 1}, {1, 2}}}}};
    const std::string page = page_of({bench_json(hostile), bench_json(hostile), reproduced});
    const auto charts = standalone_charts(page);
    const bool has_xmllint = std::system("xmllint --version > /dev/null 2>&1") == 0;
    std::set<std::string> names;
    for (const StandaloneChart& chart : charts) {
        EXPECT_TRUE(names.insert(chart.name).second) << chart.name;
        EXPECT_TRUE(std::regex_match(chart.name, std::regex("[a-z0-9][-.a-z0-9]*\\.svg"))) << chart.name;
        EXPECT_TRUE(chart.text.starts_with("<?xml version=\"1.0\"")) << chart.name;
        EXPECT_FALSE(contains(chart.text, "var(")) << "not every program knows CSS variables";
        EXPECT_EQ(chart.text.find("http", chart.text.find("2000/svg\"")), chart.text.find("https://example.org"))
            << "only as text of hostile names";
        EXPECT_FALSE(contains(chart.text, "href"));
        const std::regex reference("url\\(#([a-z0-9]+)\\)");
        for (auto it = std::sregex_iterator(chart.text.begin(), chart.text.end(), reference);
             it != std::sregex_iterator(); ++it)
            EXPECT_TRUE(contains(chart.text, "<marker id=\"" + (*it)[1].str() + "\"")) << chart.name;
        write_file(folder_ / chart.name, chart.text);
        if (has_xmllint) {
            const std::string command = "xmllint --nonet --noout '" + (folder_ / chart.name).string() + "'";
            EXPECT_EQ(std::system(command.c_str()), 0) << chart.text;
        }
    }
    std::size_t drawn = 0;
    for (std::size_t at = page.find("<svg viewBox"); at != std::string::npos; at = page.find("<svg viewBox", at + 1))
        ++drawn;
    EXPECT_EQ(charts.size(), drawn);
    EXPECT_GE(drawn, 10u);
    EXPECT_TRUE(names.contains("rates-of-the-gpus-on-cubes-2-views-of-smoke-at-24-16-primary-rays.svg"));
}

TEST_F(ReportPage, charts_have_the_colours_of_their_series)
{
    for (const StandaloneChart& chart : standalone_charts(page_of({bench_json()})))
        if (chart.name.starts_with("rates-of-the-gpus")) {
            const std::size_t cuda = api_series("cuda");
            EXPECT_TRUE(contains(chart.text, fmt::format("class=\"mark s{} ", cuda)));
            EXPECT_TRUE(contains(chart.text, fmt::format(".s{} .bar {{ fill: #009e73; ", cuda))) << chart.text;
        }
}
