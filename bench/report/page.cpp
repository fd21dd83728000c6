#include "bench/report/page.h"

#include "bench/options/identity.h"
#include "bench/output/trust.h"
#include "bench/report/campaign/campaign.h"
#include "bench/report/html/svg.h"
#include "bench/report/png.h"
#include "bench/report/sections.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tetrace {

Section picture_section(const ReportInput& input)
{
    Section section{"pictures", "Pictures", {}};
    Html pictures;
    for (const std::filesystem::path& path : input.pictures)
        pictures += picture_figure(path);
    if (!pictures.empty()) section.content = side_by_side(pictures);
    return section;
}

namespace {

/// The page loads nothing: no script, no request, only its own styles and embedded pictures.
const char* const content_policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

using StatusCounts = std::map<Status, std::size_t>;

/// "20 rows: 18 ok, 2 flawed".
std::string status_summary(const StatusCounts& counts)
{
    std::size_t all = 0;
    std::string statuses;
    for (const auto& [status, count] : counts) {
        statuses += fmt::format("{}{} {}", statuses.empty() ? ": " : ", ", count, name_of(status));
        all += count;
    }
    return counted(all, "row", "rows") + statuses;
}

StatusCounts statuses_of(const ReportInput& input)
{
    StatusCounts counts;
    for (const ReportRow& row : input.rows)
        ++counts[row.row->status];
    return counts;
}

StatusCounts statuses_of(const Campaign& campaign)
{
    StatusCounts counts;
    for (const CampaignResult& result : campaign.results)
        for (const auto& [status, count] : result.statuses)
            counts[status] += count;
    return counts;
}

/// Claims by verdict over all tables and figures; empty if there are none.
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
                                  counted(all, "claim", "claims"), verdicts[0].second, verdicts[1].second,
                                  verdicts[2].second);
}

Html trust_line(const std::string& letter, bool noisy, const std::string& sentence)
{
    return element("p", {{"class", noisy ? "trust fair" : "trust"}},
                   text_element("strong", "", letter.empty() ? "Trust" : "Trust " + letter) + text(": " + sentence));
}

/// Of many results, the noisy rows of all. counts: of a result, rows that are noisy, and that were timed.
Html trust_sum(const std::vector<std::pair<std::size_t, std::size_t>>& counts)
{
    std::size_t noisy = 0, timed = 0, results = 0;
    for (const auto& [noisy_rows, timed_rows] : counts) {
        noisy += noisy_rows;
        timed += timed_rows;
        results += noisy_rows > 0;
    }
    if (timed == 0) return {};
    return trust_line("", noisy > 0,
                      fmt::format("{} of {} rows noisy, in {} of {}, which are listed below.", with_commas(noisy),
                                  with_commas(timed), results, counted(counts.size(), "result", "results")));
}

constexpr std::size_t max_trust_lines = 6; // more push the answer from the first screen

/// Whether to trust the rates, result by result, as `bench` and `show` say it.
Html trust_lines(const ReportInput& input)
{
    Html lines;
    std::vector<std::pair<std::size_t, std::size_t>> counts;
    for (std::size_t i = 0; i < input.files.size(); ++i) {
        const Steadiness steadiness = read_steadiness(input.files[i].section());
        counts.emplace_back(steadiness.noisy, steadiness.timed);
        if (steadiness.timed > 0)
            lines += trust_line(file_letter(i, input.files.size()), steadiness.noisy > 0, trust_text(steadiness));
    }
    return counts.size() <= max_trust_lines ? lines : trust_sum(counts);
}

Html trust_lines(const Campaign& campaign)
{
    std::vector<std::pair<std::size_t, std::size_t>> counts;
    for (const CampaignResult& result : campaign.results)
        counts.emplace_back(result.noisy, result.timed);
    return trust_sum(counts);
}

/// The title over whether to trust the rates, facts that sum the results up, and what answers at once.
Html page_head(const Html& trust, const std::vector<std::string>& facts, const Html& answer)
{
    Html summary;
    for (const std::string& fact : facts)
        summary += text_element("li", "", fact);
    return element("header", {},
                   text_element("h1", "", "tetrace report") + trust +
                       text_element("p", "note",
                                    "Ray traversal through constrained Delaunay tetrahedralizations, measured and "
                                    "verified; written by tetrace " +
                                        build_identity().version + ".") +
                       element("ul", {{"class", "summary"}}, summary) + answer);
}

std::vector<std::string> facts_of(const ReportInput& input)
{
    std::vector<std::string> facts = {counted(input.files.size(), "result", "results")};
    if (!input.rows.empty()) facts.push_back(status_summary(statuses_of(input)));
    if (std::string claims = claim_summary(input); !claims.empty()) facts.push_back(std::move(claims));
    return facts;
}

std::vector<std::string> facts_of(const Campaign& campaign)
{
    std::vector<std::string> facts = {counted(campaign.results.size(), "result", "results"),
                                      counted(campaign.machines.size(), "machine", "machines"),
                                      fmt::format("{} to {} UTC", minute_of(campaign.results.front().head.date),
                                                  minute_of(campaign.results.back().head.date)),
                                      status_summary(statuses_of(campaign))};
    if (!campaign.left_out.empty())
        facts.push_back(counted(campaign.left_out.size(), "file left out", "files left out"));
    return facts;
}

Html contents(const std::vector<Section>& sections)
{
    Html links;
    for (const Section& section : sections)
        links += element("a", {{"href", "#" + section.id}}, text(section.title));
    return element("nav", {}, links);
}

Html meta(const char* key, const char* name, const char* content)
{
    return element("meta", {{key, name}, {"content", content}});
}

std::string page_of(const Html& header, std::vector<Section> sections)
{
    std::erase_if(sections, [](const Section& section) { return section.content.empty(); });
    Html body;
    for (const Section& section : sections)
        body += element("section", {{"id", section.id}}, text_element("h2", "", section.title) + section.content);
    const Html head =
        element("meta", {{"charset", "utf-8"}}) + meta("http-equiv", "Content-Security-Policy", content_policy) +
        meta("name", "viewport", "width=device-width, initial-scale=1") + meta("name", "color-scheme", "light dark") +
        text_element("title", "", "tetrace report") + style_sheet();
    return whole_page(head, mark_definitions(body) + header + contents(sections) + element("main", {}, body)).str();
}

} // namespace

std::string report_page(const ReportInput& input)
{
    std::vector<Section> sections;
    for (const auto make :
         {comparison_section, machine_section, rate_section, size_section, thread_section, ratio_section,
          roofline_section, conformance_section, compiler_section, paper_section, picture_section, time_section})
        sections.push_back(make(input));
    return page_of(page_head(trust_lines(input) + comparison_summary(input), facts_of(input), headline(input)),
                   sections);
}

std::string campaign_page(const Campaign& campaign, const std::vector<std::filesystem::path>& pictures)
{
    std::vector<Section> sections;
    for (const auto make : {index_section, machines_section, portability_section, trend_section})
        sections.push_back(make(campaign));
    if (!pictures.empty()) sections.push_back(picture_section({{}, {}, pictures, {}}));
    return page_of(page_head(trust_lines(campaign), facts_of(campaign), {}), sections);
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
    input.comparison = comparison_of(input.files);
    input.pictures = std::move(pictures);
    return input;
}

} // namespace tetrace
