#pragma once

#include "bench/report/page.h"
#include "tests/output/report_results.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <fmt/format.h>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tetrace::test {

/// How often a text has a part.
[[nodiscard]] inline std::size_t occurrences(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
        ++count;
    return count;
}

/// The rows that have an element of this class.
[[nodiscard]] inline std::multiset<std::string> rows_of(const std::string& page, const std::string& css_class)
{
    std::multiset<std::string> rows;
    const std::regex mark("class=\"" + css_class + "[^\"]*\" data-row=\"([^\"]*)\"");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), mark); it != std::sregex_iterator(); ++it)
        rows.insert((*it)[1]);
    return rows;
}

/// The part of a page from the heading of one section to the next.
[[nodiscard]] inline std::string section_of(const std::string& page, const std::string& id)
{
    const std::size_t begin = page.find("<section id=\"" + id + "\"");
    if (begin == std::string::npos) return "no section " + id;
    return page.substr(begin, page.find("</section>", begin) - begin);
}

/// The page of results that a case gives.
class ReportPage : public testing::Test {
protected:
    std::string page_of(const std::vector<json>& results, std::vector<std::filesystem::path> pictures = {})
    {
        std::vector<std::filesystem::path> files;
        for (const json& result : results) {
            files.push_back(folder_ / fmt::format("{}.json", files.size()));
            write_file(files.back(), result.dump());
        }
        return tetrace::report_page(read_report_input(files, std::move(pictures)));
    }
    std::string error_of_page(const json& result, std::vector<std::filesystem::path> pictures = {})
    {
        return error_of([&] { static_cast<void>(page_of({result}, std::move(pictures))); });
    }

    TemporaryFolder folder_;
};

/// A PNG of one white pixel.
inline const std::string
    white_pixel("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT"
                "\x78\x9c\x63\xf8\x0f\0\x01\x01\x01\0\x1b\xb6\xee\x56\0\0\0\0IEND\xae\x42\x60\x82",
                67);

} // namespace tetrace::test
