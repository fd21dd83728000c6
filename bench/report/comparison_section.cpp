#include "bench/output/compare_report.h"
#include "bench/report/charts/axis.h"
#include "bench/report/sections.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_changes =
    "The rate of a row in B over its rate in A, by medians, with the interval from the samples of both; above 1, B is "
    "faster. Verdicts are those of 'tetrace compare' with a tolerance of 3 %. NOISY: the machine's own speed changed, "
    "so the row decides nothing. noisy: the rate of a result is, by its own samples or its machine.";

bool are_two_with_samples(const std::vector<ResultFile>& files)
{
    const auto is_timed = [](const ResultRow* row) { return !row->samples_s.empty(); };
    return files.size() == 2 && std::ranges::all_of(files, [&](const ResultFile& file) {
               return std::ranges::any_of(file.timed_rows(), is_timed);
           });
}

/// "bunny: cdt maria tet80 vulkan"; of searches the row's name.
Html label_of(const ReportInput& input, const ComparedRow& compared)
{
    for (const ReportRow& row : input.rows)
        if (row.row == compared.before || row.row == compared.after)
            return text(fmt::format("{}: {} {}", row.row->scene, row.kernel_and_rays(), row.api));
    return text_element("code", "", compared.name());
}

Html ratio_of(const ComparedRow& row)
{
    if (!row.change) return {};
    const bool noisy = row.before->noisy || row.after->noisy;
    std::string ratio = fmt::format("{:.2f}", row.change->ratio);
    if (const auto& interval = row.change->interval)
        ratio += fmt::format(" [{:.2f}, {:.2f}]", interval->low, interval->high);
    return text(ratio) + (noisy ? text_element("small", "", "noisy") : Html());
}

Html rate_of(const ResultRow* row)
{
    return row != nullptr && row->mrays_per_s ? text(short_number(*row->mrays_per_s)) : Html();
}

} // namespace

std::optional<ResultComparison> comparison_of(const std::vector<ResultFile>& files)
{
    if (!are_two_with_samples(files)) return std::nullopt;
    try {
        return compare_results(files[0], files[1], {}, Options().tolerance);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::invalid_input) throw;
        return std::nullopt; // they share no work
    }
}

Html comparison_summary(const ReportInput& input)
{
    if (input.comparison)
        return element("p", {{"class", "verdict"}},
                       text_element("strong", "", "B over A") + text(": " + summary_text(*input.comparison)));
    if (!are_two_with_samples(input.files)) return {};
    return element("p", {{"class", "verdict"}},
                   text("A and B have no row of the same work, so B over A is not known; 'tetrace compare' names what "
                        "differs."));
}

Section comparison_section(const ReportInput& input)
{
    Section section{"compared", "B over A", {}};
    if (!input.comparison) return section;
    HtmlTable table(
        {{"row"}, {"B / A", {}, true}, {"verdict"}, {"A", "Mrays/s", true}, {"B", "Mrays/s", true}, {"why"}});
    for (const ComparedRow& row : input.comparison->rows) {
        if (row.outcome == RowOutcome::untimed) continue;
        table.add({label_of(input, row), ratio_of(row), badge(row.verdict()), rate_of(row.before), rate_of(row.after),
                   text(row.note())});
    }
    section.content = note(how_to_read_changes) + table.html();
    return section;
}

} // namespace tetrace
