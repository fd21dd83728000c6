#include "bench/report/charts/bar_chart.h"
#include "bench/report/sections.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <span>

namespace tetrace {

namespace {

constexpr std::size_t max_charts = 2; // more do not fit a first screen

/// A contest of timed rows that has tets and BVHs: which structure is faster?
struct StructureContest : Contest<ReportRow> {
    const RowGroup* group = nullptr;
    std::string device;
    const ReportRow *walk = nullptr, *bvh = nullptr; ///< the fastest

    [[nodiscard]] double ratio() const { return walk->rate->mrays_per_s / bvh->rate->mrays_per_s; }
    [[nodiscard]] bool is_shaky() const { return is_noisy(*walk) || is_noisy(*bvh); }
};

/// Of primary rays; GPUs' first. Emulated devices are in none: they are not to be ranked. Nor are kernels ranked with
/// one that is not known.
std::vector<StructureContest> structure_contests(const std::vector<RowGroup>& groups, std::size_t files)
{
    std::vector<StructureContest> contests;
    for (const RowGroup& group : groups) {
        if (group.kind == DeviceKind::emulated || group.rays != RayKind::primary || group.task != Task::trace) continue;
        for (auto& contest : contests_of(group.rows, [&](const ReportRow&a, const ReportRow&b) {
                 return device_text(a, files) == device_text(b, files) && a.row->threads == b.row->threads &&
                        a.row->in_flight == b.row->in_flight;
             })) {
            if (contest.rows.front()->row->threads > 0) continue; // those with the most answer for the others
            if (!std::ranges::all_of(contest.rows, [](const ReportRow* row) { return row->known_kernel.has_value(); }))
                continue;
            const ReportRow *const walk = contest.fastest(Walk::any), *const bvh = contest.fastest(Rival::any);
            const std::string device = device_text(*contest.rows.front(), files);
            if (walk != nullptr && bvh != nullptr) contests.push_back({std::move(contest), &group, device, walk, bvh});
        }
    }
    std::ranges::stable_sort(contests, std::greater(),
                             [](const StructureContest& one) { return one.group->kind == DeviceKind::gpu; });
    return contests;
}

std::string bvh_text(const StructureContest& contest)
{
    return contest.bvh_text(*contest.bvh, contest.bvh->label());
}

std::string answer_text(const StructureContest& contest)
{
    const double ratio = contest.ratio();
    return fmt::format("{} on {}: rays go through the tets {:.2f} times as {} as through {}", contest.group->scene.name,
                       contest.device, std::max(ratio, 1 / ratio), ratio >= 1 ? "fast" : "slowly", bvh_text(contest));
}

/// The fastest of each structure, and the paper's own pair.
Html chart_of(const StructureContest& contest)
{
    std::vector<const ReportRow*> shown;
    for (const ReportRow* row :
         {contest.walk, contest.bvh, contest.fastest(Walk::maria), contest.fastest(Layout::bvh2)})
        if (row != nullptr && std::ranges::find(shown, row) == shown.end()) shown.push_back(row);
    std::ranges::stable_sort(shown, std::greater(), [](const ReportRow* row) { return row->rate->mrays_per_s; });
    BarChart chart{contest.is_shaky()
                       ? fmt::format("{} on {}: noisy, no ratio to rely on", contest.group->scene.name, contest.device)
                       : answer_text(contest),
                   "Mrays/s",
                   {}};
    for (const ReportRow* row : shown)
        chart.bars.push_back({row->name(),
                              row->kernel() + "  " + row->api,
                              "",
                              api_series(row->row->backend),
                              row->rate->mrays_per_s,
                              row->rate->low,
                              row->rate->high,
                              {},
                              remark_of(*row)});
    return figure(chart.label, draw(chart), contest.is_shaky() ? "noisy: " + answer_text(contest) : "");
}

/// "Rate of the tets on a device: bunny 1.41 of that of the fastest BVH, bvh cwbvh on cuda, armadillo ..." for each
/// device of the contests without a chart.
Html other_answers(std::span<const StructureContest> contests)
{
    std::vector<std::pair<std::string, std::string>> lines;
    for (const StructureContest& contest : contests) {
        const auto same = std::ranges::find(lines, contest.device, &std::pair<std::string, std::string>::first);
        std::string& line = (same == lines.end() ? lines.emplace_back(contest.device, "") : *same).second;
        append_item(line, "; ",
                    fmt::format("{} {:.2f} of that of {}{}", contest.group->scene.name, contest.ratio(),
                                bvh_text(contest), contest.is_shaky() ? " (noisy)" : ""));
    }
    Html items;
    for (const auto& [device, line] : lines)
        items += text_element("li", "", fmt::format("Rate of the tets on {}: {}.", device, line));
    return items.empty() ? items : element("ul", {{"class", "plain note"}}, items);
}

Html rates_answer(const ReportInput& input)
{
    const auto groups = rated_groups(input.files, input.rows);
    const auto contests = structure_contests(groups, input.files.size());
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
        right += has_answers(row.row->status);
        if (row.row->status == Status::wrong) wrong.push_back(&row);
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
