// The page is well-formed, whatever characters the results have, and loads and runs nothing.
#include "tests/output/report_fixture.h"

#include <regex>
#include <set>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The tags of a page in their order, attributes and text left out. What quotes enclose is not a tag.
std::vector<std::string> tags_of(const std::string& page)
{
    std::vector<std::string> tags;
    const std::regex tag("<(/?[a-z0-9]+)(?: [-a-zA-Z0-9]+=\"[^\"]*\")*>");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), tag); it != std::sregex_iterator(); ++it)
        tags.push_back((*it)[1]);
    return tags;
}

} // namespace

TEST_F(ReportPage, tags_are_balanced)
{
    write_file(folder_ / "a.png", white_pixel);
    std::vector<std::string> open;
    for (const std::string& tag : tags_of(page_of({bench_json(), check_json(), reproduce_json()}, {folder_ / "a.png"})))
        if (tag[0] == '/') {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(open.back(), tag.substr(1));
            open.pop_back();
        } else if (tag != "meta" && tag != "img") {
            open.push_back(tag);
        }
    EXPECT_TRUE(open.empty());
}

TEST_F(ReportPage, every_mark_that_is_referred_to_is_defined_once)
{
    json reproduced = reproduce_json();
    reproduced["tetrace"]["figures"][0]["series"] = {{{"name", "a"}, {"points", {{2, 1}, {1, 2}}}},
                                                     {{"name", "b"}, {"points", {{3, 1}, {1, 2}}}}};
    const std::string page = page_of({bench_json(), reproduced});
    std::set<std::string> marks;
    const std::regex reference("url\\(#([a-z0-9]+)\\)");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), reference); it != std::sregex_iterator(); ++it)
        marks.insert((*it)[1]);
    EXPECT_EQ(marks, (std::set<std::string>{"cloud0", "cloud1", "sample"}));
    for (const std::string& mark : marks) {
        const std::string id = "id=\"" + mark + "\"";
        EXPECT_TRUE(contains(page, id)) << mark;
        EXPECT_EQ(page.find(id), page.rfind(id)) << mark;
    }
}

TEST_F(ReportPage, names_of_whatever_characters_change_no_markup)
{
    const auto tags = [&](const Names& names) {
        return tags_of(page_of({bench_json(names), check_json(names), reproduce_json(names)}));
    };
    EXPECT_EQ(tags(hostile), tags(innocent));
    const std::string page = page_of({bench_json(hostile)});
    EXPECT_TRUE(contains(page, "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &apos;Co&apos;"));
}

TEST_F(ReportPage, loads_nothing_and_runs_nothing)
{
    write_file(folder_ / "a.png", white_pixel);
    const std::string page = page_of({bench_json(hostile), check_json(hostile)}, {folder_ / "a.png"});
    for (const std::string& tag : tags_of(page))
        EXPECT_TRUE(tag != "script" && tag != "link" && tag != "iframe" && tag != "object") << tag;
    const std::regex source("<[^>\"]*(?: [-a-zA-Z0-9]+=\"[^\"]*\")* (src|href|srcset|data|on[a-z]+)=\"([^\"]{0,30})");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), source); it != std::sregex_iterator(); ++it) {
        const std::string target = (*it)[2];
        EXPECT_TRUE(target.rfind("#", 0) == 0 || target.rfind("data:image/png;base64,", 0) == 0) << it->str();
    }
    const std::string style = page.substr(page.find("<style>"), page.find("</style>") - page.find("<style>"));
    EXPECT_EQ(style.find("url("), std::string::npos);
    EXPECT_EQ(style.find("@import"), std::string::npos);
    EXPECT_TRUE(contains(page, "content=\"default-src &apos;none&apos;; style-src"));
}
