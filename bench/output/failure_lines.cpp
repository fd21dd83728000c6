#include "bench/measuring/budget.h"
#include "bench/output/bench_report.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// Rows without an answer that have the same reason. The reasons of rows that --budget skips differ only in the row's
/// own time, and count as the same.
struct Unanswered {
    const RowRecord* first;
    Status status;
    std::string what, common;
    std::size_t count = 0;
    bool of_one_scene = true;

    [[nodiscard]] bool is_fault() const { return status != Status::skipped && status != Status::unsupported; }
    /// "--budget 7m is enough", or the first line of the reason.
    [[nodiscard]] std::string shortly() const
    {
        if (common == what) return what.substr(0, what.find('\n'));
        const std::size_t budget = std::string_view(with_budget).size();
        return "--budget " + common.substr(budget, common.find(' ', budget) - budget) + " is enough";
    }
};

/// Of a row whose scene could not be loaded only the beginning of the reason: standard error has had all of it.
Unanswered unanswered(const RowRecord& row)
{
    std::string reason = reason_of(row);
    if (row.device.name.empty()) reason = reason.substr(0, reason.find('\n'));
    const std::size_t budget = reason.find(with_budget);
    return {&row, status_of(row), reason, budget == std::string::npos ? reason : reason.substr(budget)};
}

std::vector<Unanswered> all_unanswered(const std::vector<RowRecord>& rows)
{
    std::vector<Unanswered> groups;
    for (const RowRecord& row : rows) {
        if (has_answers(row)) continue;
        Unanswered one = unanswered(row);
        const auto same = std::ranges::find_if(
            groups, [&](const Unanswered& group) { return group.status == one.status && group.common == one.common; });
        Unanswered& group = same == groups.end() ? groups.emplace_back(std::move(one)) : *same;
        ++group.count;
        group.of_one_scene = group.of_one_scene && group.first->key.scene == row.key.scene;
    }
    return groups;
}

/// Names the row, or the first of several.
std::string whole_line(const Unanswered& group)
{
    const std::string name = row_name(group.first->key),
                      what = fmt::format("{}: {}", name_of(group.status), group.what);
    if (group.count == 1) return fmt::format("{}: {}", name, what);
    const bool tells_scene = group.of_one_scene && group.common == group.what;
    return fmt::format("{} rows{}, such as {}: {}", group.count, tells_scene ? " of " + group.first->key.scene : "",
                       name, what);
}

/// "7 rows did not run: 4 skipped (--budget 7m is enough), 3 unsupported (no such buffers)."
std::string common_line(const std::vector<Unanswered>& groups)
{
    std::size_t count = 0;
    std::string parts;
    for (const Unanswered& group : groups) {
        count += group.count;
        const std::string who = group.count == 1 ? row_name(group.first->key) : std::to_string(group.count);
        append_item(parts, ", ", fmt::format("{} {} ({})", who, name_of(group.status), group.shortly()));
    }
    return fmt::format("{} rows did not run: {}.", count, parts);
}

} // namespace

Sheet failure_lines(const std::vector<RowRecord>& rows)
{
    auto groups = all_unanswered(rows);
    const auto idle =
        std::stable_partition(groups.begin(), groups.end(), [](const Unanswered& group) { return group.is_fault(); });
    const std::vector<Unanswered> idle_groups(idle, groups.end());
    groups.erase(idle, groups.end());
    Sheet sheet;
    for (const Unanswered& group : groups)
        sheet.line(whole_line(group));
    if (!idle_groups.empty())
        sheet.line(idle_groups.size() == 1 ? whole_line(idle_groups.front()) : common_line(idle_groups));
    if (!groups.empty() || !idle_groups.empty()) sheet.gap();
    return sheet;
}

} // namespace tetrace
