// The page in Chromium, if there is one: it opens without a message, and every chart has its data.
#include "tests/output/report_fixture.h"

#include <cstdlib>
#include <fmt/format.h>
#include <set>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::string find_chromium()
{
    for (const char* const name : {"chromium", "chromium-headless-shell", "google-chrome", "chrome"})
        if (std::system(fmt::format("command -v {} > /dev/null 2>&1", name).c_str()) == 0) return name;
    return {};
}

/// What a browser makes of a page: its document as text, and what it wrote to its console.
struct Browsed {
    std::string document, console;
};

class ReportInChromium : public ReportPage {
protected:
    void SetUp() override
    {
        browser_ = find_chromium();
        if (browser_.empty())
            GTEST_SKIP() << "no Chromium (Debian's package chromium-headless-shell): the page was opened by nobody";
    }
    Browsed browse(const std::string& page)
    {
        write_file(folder_ / "page.html", page);
        const auto document = folder_ / "document", log = folder_ / "log";
        const std::string command = fmt::format(
            "HOME='{0}' timeout 60 {1} --headless --no-sandbox --disable-gpu --disable-dev-shm-usage "
            "--user-data-dir='{0}/profile' --enable-logging=stderr --dump-dom 'file://{0}/page.html' > '{2}' 2> '{3}'",
            folder_.path().string(), browser_, document.string(), log.string());
        EXPECT_EQ(std::system(command.c_str()), 0) << read_text(log);
        Browsed browsed{read_text(document), {}};
        const std::string text = read_text(log);
        for (std::size_t at = text.find("CONSOLE"); at != std::string::npos; at = text.find("CONSOLE", at + 1))
            browsed.console += text.substr(at, text.find('\n', at) - at) + "\n";
        return browsed;
    }

    std::string browser_;
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
