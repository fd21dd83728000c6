#include "bench/report/page.h"

#include "bench/options/identity.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// The page loads nothing: no script, no request, only its own styles and embedded pictures.
const char* const content_policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

std::string count_text(std::size_t count, const char* one, const char* several)
{
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// "20 rows: 18 ok, 2 flawed".
std::string status_summary(const ReportInput& input)
{
    std::string text = count_text(input.rows.size(), "row", "rows");
    const char* separator = ": ";
    for (const char* const status : {"ok", "flawed", "wrong", "unsupported", "skipped", "error"}) {
        const auto count =
            std::ranges::count_if(input.rows, [&](const ReportRow& row) { return row.row->status == status; });
        if (count > 0) text += fmt::format("{}{} {}", std::exchange(separator, ", "), count, status);
    }
    return text;
}

/// Claims by verdict over all tables and figures; empty where there are none.
std::string claim_summary(const ReportInput& input)
{
    std::vector<std::pair<std::string, std::size_t>> verdicts = {
        {"holds", 0}, {"does not hold", 0}, {"not testable here", 0}};
    for (const ResultFile& file : input.files)
        for (const char* const key : {"tables", "figures"})
            if (const auto parts = file.section().find(key))
                for (const ResultValue& part : parts->items())
                    if (const auto claims = part.find("claims"))
                        for (const ResultValue& claim : claims->items())
                            for (auto& [verdict, count] : verdicts)
                                count += claim.at("verdict").line() == verdict;
    const std::size_t all = verdicts[0].second + verdicts[1].second + verdicts[2].second;
    return all == 0 ? ""
                    : fmt::format("{} of the paper: {} hold, {} do not hold, {} not testable here",
                                  count_text(all, "claim", "claims"), verdicts[0].second, verdicts[1].second,
                                  verdicts[2].second);
}

Html page_head(const ReportInput& input)
{
    Html summary = text_element("li", "", count_text(input.files.size(), "result", "results"));
    if (!input.rows.empty()) summary += text_element("li", "", status_summary(input));
    if (const std::string claims = claim_summary(input); !claims.empty()) summary += text_element("li", "", claims);
    return element("header", {},
                   text_element("h1", "", "tetrace report") +
                       text_element("p", "note",
                                    "Ray traversal through constrained Delaunay tetrahedralizations, measured and "
                                    "verified; written by tetrace " +
                                        build_identity().version + ".") +
                       element("ul", {{"class", "summary"}}, summary) + headline(input));
}

Html contents(const std::vector<Section>& sections)
{
    Html links;
    for (const Section& section : sections)
        if (!section.is_empty) links += element("a", {{"href", "#" + section.id}}, text(section.title));
    return element("nav", {}, links);
}

Html meta(const char* key, const char* name, const char* content)
{
    return element("meta", {{key, name}, {"content", content}});
}

} // namespace

std::string report_page(const ReportInput& input)
{
    std::vector<Section> sections;
    for (const auto make : {machine_section, rate_section, ratio_section, roofline_section, conformance_section,
                            compiler_section, paper_section, picture_section, time_section})
        sections.push_back(make(input));
    Html body;
    for (const Section& section : sections)
        body += element("section", {{"id", section.id}}, text_element("h2", "", section.title) + section.content);
    const Html head =
        element("meta", {{"charset", "utf-8"}}) + meta("http-equiv", "Content-Security-Policy", content_policy) +
        meta("name", "viewport", "width=device-width, initial-scale=1") + meta("name", "color-scheme", "light dark") +
        text_element("title", "", "tetrace report") + style_sheet();
    return whole_page(head, page_head(input) + contents(sections) + element("main", {}, body)).str();
}

ReportInput read_report_input(const std::vector<std::filesystem::path>& results,
                              std::vector<std::filesystem::path> pictures)
{
    ReportInput input;
    for (const std::filesystem::path& path : results)
        input.files.push_back(read_result(path));
    for (std::size_t file = 0; file < input.files.size(); ++file) // rows refer to files, which no longer move
        for (ReportRow& row : report_rows(input.files[file], file))
            input.rows.push_back(std::move(row));
    input.pictures = std::move(pictures);
    return input;
}

} // namespace tetrace
