#include "bench/report/charts/bar_chart.h"
#include "bench/report/sections.h"
#include "bench/rows/best_bvh.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <span>

namespace tetrace {

namespace {

constexpr std::size_t max_charts = 2; // more do not fit a first screen

/// The rows of one device that traced the same rays: which structure is faster?
struct Contest {
    const RowGroup* group = nullptr;
    std::string device;
    std::vector<const ReportRow*> rows; ///< fastest first

    /// The fastest whose kernel's name begins so; null if there is none.
    [[nodiscard]] const ReportRow* fastest(std::string_view beginning) const
    {
        const auto found =
            std::ranges::find_if(rows, [&](const ReportRow* row) { return row->kernel.starts_with(beginning); });
        return found == rows.end() ? nullptr : *found;
    }
    [[nodiscard]] double ratio() const { return fastest("cdt ")->rate->mrays_per_s / rate_of_bvh(); }
    /// "the fastest BVH, bvh packet16 on embree".
    [[nodiscard]] std::string bvh() const
    {
        const auto list = contenders();
        return bvh_text(list, *best_bvh(list, 0));
    }

private:
    [[nodiscard]] std::vector<Contender> contenders() const
    {
        std::vector<Contender> list;
        for (const ReportRow* row : rows)
            list.push_back({.name = row->kernel + " on " + row->api,
                            .arena = "",
                            .is_bvh = row->kernel.starts_with("bvh "),
                            .mrays_per_s = row->rate->mrays_per_s});
        return list;
    }
    [[nodiscard]] double rate_of_bvh() const
    {
        const auto list = contenders();
        return list[*best_bvh(list, 0)].mrays_per_s;
    }
};

/// Of primary rays and both structures; GPUs' first. Emulated devices are in none: they are not to be ranked.
std::vector<Contest> contests_of(const std::vector<RowGroup>& groups, std::size_t files)
{
    std::vector<Contest> contests;
    for (const RowGroup& group : groups) {
        if (group.kind == DeviceKind::emulated || group.rays != "primary") continue;
        const std::size_t first = contests.size();
        for (const ReportRow* row : group.rows) {
            const std::string device = device_text(*row, files);
            const auto same =
                std::ranges::find_if(contests.begin() + static_cast<std::ptrdiff_t>(first), contests.end(),
                                     [&](const Contest& other) { return other.device == device; });
            (same == contests.end() ? contests.emplace_back(Contest{&group, device, {}}) : *same).rows.push_back(row);
        }
    }
    std::erase_if(contests, [](const Contest& one) { return !one.fastest("cdt ") || !one.fastest("bvh "); });
    std::ranges::stable_sort(contests, std::greater(),
                             [](const Contest& one) { return one.group->kind == DeviceKind::gpu; });
    return contests;
}

std::string answer_text(const Contest& contest)
{
    const double ratio = contest.ratio();
    return fmt::format("{} on {}: rays go through the tets {:.2f} times as {} as through {}", contest.group->scene.name,
                       contest.device, std::max(ratio, 1 / ratio), ratio >= 1 ? "fast" : "slowly", contest.bvh());
}

/// The fastest of each structure, and the paper's own pair.
Html chart_of(const Contest& contest)
{
    std::vector<const ReportRow*> shown;
    for (const char* const beginning : {"cdt ", "bvh ", "cdt maria tet80", "bvh bvh2"}) {
        const ReportRow* const row = contest.fastest(beginning);
        if (row != nullptr && std::ranges::find(shown, row) == shown.end()) shown.push_back(row);
    }
    std::ranges::stable_sort(shown, std::greater(), [](const ReportRow* row) { return row->rate->mrays_per_s; });
    BarChart chart{answer_text(contest), "Mrays/s", {}};
    for (const ReportRow* row : shown)
        chart.bars.push_back({row->name(),
                              row->kernel + "  " + row->api,
                              "",
                              api_series(row->row->backend),
                              row->rate->mrays_per_s,
                              row->rate->low,
                              row->rate->high,
                              {},
                              remark_of(*row)});
    return figure(answer_text(contest), draw(chart), "");
}

/// "Rate of the tets on a device: bunny 1.41 of that of the fastest BVH, bvh cwbvh on cuda, armadillo ..." for each
/// device of the contests without a chart.
Html other_answers(std::span<const Contest> contests)
{
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Contest& contest : contests) {
        const auto same = std::ranges::find(lines, contest.device, &std::pair<std::string, std::string>::first);
        std::string& line = (same == lines.end() ? lines.emplace_back(contest.device, "") : *same).second;
        line += fmt::format("{}{} {:.2f} of that of {}", line.empty() ? "" : "; ", contest.group->scene.name,
                            contest.ratio(), contest.bvh());
    }
    Html items;
    for (const auto& [device, line] : lines)
        items += text_element("li", "", fmt::format("Rate of the tets on {}: {}.", device, line));
    return items.empty() ? items : element("ul", {{"class", "plain note"}}, items);
}

Html rates_answer(const ReportInput& input)
{
    const auto groups = rated_groups(input.files, input.rows);
    const auto contests = contests_of(groups, input.files.size());
    if (contests.empty()) return {};
    const std::size_t shown = std::min(contests.size(), max_charts);
    Html charts;
    for (std::size_t i = 0; i < shown; ++i)
        charts += chart_of(contests[i]);
    return side_by_side(charts) + other_answers(std::span(contests).subspan(shown)) +
           note("The fastest row of each structure, and the pair that the paper measured: its search (maria) and "
                "bvh2. The paper's claim, for a GeForce GTX 680: the CDT is faster on banana and bunny, and not on "
                "armadillo.");
}

/// How many rows of `check` have each conformity, with a link to the first that is wrong.
Html check_answer(const ReportInput& input)
{
    std::size_t rows = 0, right = 0;
    std::vector<const ReportRow*> wrong;
    for (const ReportRow& row : input.rows) {
        if (input.files.at(row.file).head.verb != "check") continue;
        ++rows;
        right += row.row->status == "ok" || row.row->status == "flawed";
        if (row.row->status == "wrong") wrong.push_back(&row);
    }
    if (rows == 0) return {};
    Html told = text(fmt::format("{} of {} rows of check are right. ", right, rows));
    if (!wrong.empty())
        told +=
            row_link(*wrong.front(), text(fmt::format("{} {} wrong", wrong.size(), wrong.size() == 1 ? "is" : "are"))) +
            text(", the first on " + device_text(*wrong.front(), input.files.size()) + ".");
    return element("p", {}, told);
}

} // namespace

Html headline(const ReportInput& input)
{
    const Html answer = check_answer(input) + rates_answer(input);
    return answer.empty() ? answer : element("section", {{"id", "answer"}}, answer);
}

} // namespace tetrace
