// The page in Chromium, if there is one: it opens without a message, and every chart has its data.
#include "tests/output/report_fixture.h"
#include "tests/support/chromium.h"

#include <set>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class ReportInChromium : public ReportPage {
protected:
    void SetUp() override
    {
        if (find_chromium().empty())
            GTEST_SKIP() << "no Chromium (Debian's package chromium-headless-shell): the page was opened by nobody";
    }
    Browsed browse(const std::string& page) { return test::browse(folder_.path(), page); }
};

} // namespace

TEST_F(ReportInChromium, opens_without_a_word_on_the_console_and_every_chart_has_its_data)
{
    write_file(folder_ / "a.png", white_pixel);
    const Browsed browsed =
        browse(page_of({bench_json(hostile), check_json(hostile), reproduce_json(hostile)}, {folder_ / "a.png"}));
    EXPECT_EQ(browsed.console, "");
    using Rows = std::multiset<std::string>;
    EXPECT_EQ(rows_of(section_of(browsed.document, "rates"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(browsed.document, "rates"), "unrated"), (Rows{"row/opencl"}));
    EXPECT_EQ(rows_of(section_of(browsed.document, "roofline"), "mark ").size(), 3u);
    EXPECT_EQ(rows_of(section_of(browsed.document, "ratios"), "mark ").size(), 1u);
    EXPECT_TRUE(contains(section_of(browsed.document, "paper"), "class=\"line\""));
}

TEST_F(ReportInChromium, a_page_that_loads_or_runs_something_would_be_reported)
{
    std::string page = page_of({bench_json()});
    const std::size_t body = page.find("<body>") + 6;
    page.insert(body, "<script>document.title = 1</script><img src=\"https://example.org/x.png\">");
    const std::string console = browse(page).console;
    EXPECT_TRUE(contains(console, "script"));
    EXPECT_TRUE(contains(console, "example.org"));
}
