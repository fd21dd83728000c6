#include "bench/results/result_comparison.h"

#include "bench/options/name_filter.h"
#include "bench/results/rate_pulse.h"
#include "bench/results/same_work.h"
#include "bench/statistics/statistics.h"
#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

bool is_timed(const ResultRow* row)
{
    return row != nullptr && (row->status == "ok" || row->status == "flawed") && !row->samples_s.empty();
}

bool has_failed(const ResultRow* row)
{
    return row != nullptr && (row->status == "wrong" || row->status == "error");
}

RowOutcome outcome_of(const ComparedRow& row)
{
    if (is_timed(row.before) && is_timed(row.after)) return RowOutcome::compared;
    if (is_timed(row.before)) return has_failed(row.after) ? RowOutcome::failed : RowOutcome::missing;
    return is_timed(row.after) ? RowOutcome::added : RowOutcome::untimed;
}

std::string why_untimed(const char* label, const ResultRow* row)
{
    if (is_timed(row)) return {};
    if (row == nullptr) return fmt::format("{}: no such row", label);
    if (!row->reason.empty()) return fmt::format("{}: {}: {}", label, row->status, row->reason);
    const bool has_rate = row->status == "ok" || row->status == "flawed";
    return fmt::format("{}: {}", label, has_rate ? "no samples" : row->status);
}

std::vector<ComparedRow> paired_rows(const ResultFile& before, const ResultFile& after, const std::string& filter)
{
    const NameFilter names("--filter", filter);
    const auto kept = [&](const ResultRow& row) { return names.keeps(row.name); };
    std::vector<ComparedRow> rows;
    for (const ResultRow* row : before.timed_rows())
        if (kept(*row)) rows.push_back({row, after.find_row(row->name), {}, {}, {}});
    for (const ResultRow* row : after.timed_rows())
        if (kept(*row) && before.find_row(row->name) == nullptr) rows.push_back({nullptr, row, {}, {}, {}});
    for (ComparedRow& row : rows)
        row.outcome = outcome_of(row);
    return rows;
}

[[noreturn]] void reject_pair(const ResultFile& before, const ResultFile& after, const std::string& why)
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("comparing A, '{}' (of 'tetrace {}'), with B, '{}' (of 'tetrace {}'): {}",
                            before.path.string(), before.head.verb, after.path.string(), after.head.verb, why));
}

/// Takes the rows that did different work out of the comparison. Some are expected: Embree's answers, and those of math
/// mode fast, depend on the processor.
void find_different_work(const ResultFile& before, const ResultFile& after, std::vector<ComparedRow>& rows)
{
    std::string reasons;
    bool any_compared = false;
    for (ComparedRow& row : rows) {
        if (row.outcome != RowOutcome::compared) continue;
        row.difference = different_work(before, *row.before, after, *row.after);
        any_compared = any_compared || row.difference.empty();
        if (row.difference.empty()) continue;
        row.outcome = RowOutcome::different;
        reasons += fmt::format("\n  {}: {}", row.name(), row.difference);
    }
    if (!any_compared && !reasons.empty())
        reject_pair(before, after,
                    fmt::format("no row did the same work in both, so no times are comparable:{}\n"
                                "measure both on the same scenes and views",
                                reasons));
}

void require_rows(const ResultFile& before, const ResultFile& after, const std::vector<ComparedRow>& rows,
                  const std::string& filter)
{
    if (rows.empty())
        reject_pair(before, after,
                    filter.empty() ? "neither has a row" : fmt::format("--filter '{}' matches no row", filter));
    if (std::ranges::none_of(rows, [](const ComparedRow& row) { return is_timed(row.before); }))
        reject_pair(before, after,
                    "A lacks rows with samples to compare with; 'tetrace bench --out FILE.json' times rows");
    const auto is_common = [](const ComparedRow& row) { return row.before != nullptr && row.after != nullptr; };
    if (std::ranges::none_of(rows, is_common))
        reject_pair(
            before, after,
            fmt::format("they share no row; A has {} and similar rows, B {}", rows.front().name(),
                        after.timed_rows().empty() ? "none" : after.timed_rows().front()->name + " and similar rows"));
}

} // namespace

std::string ComparedRow::verdict() const
{
    switch (outcome) {
    case RowOutcome::compared: return is_noisy() ? "NOISY" : std::string(name_of(change->verdict));
    case RowOutcome::different: return "DIFFERENT";
    case RowOutcome::failed: return "FAILED";
    case RowOutcome::missing: return "MISSING";
    case RowOutcome::added: return "NEW";
    case RowOutcome::untimed: return "NOT TIMED";
    }
    throw Error(ErrorKind::internal, "ComparedRow::verdict: no such outcome");
}

std::string ComparedRow::note() const
{
    if (is_noisy()) return disturbance;
    if (has_too_few_samples())
        return fmt::format("fewer than {} samples, so no interval: {} in A and {} in B", min_samples,
                           before->samples_s.size(), after->samples_s.size());
    if (outcome == RowOutcome::different) return difference;
    const std::string a = why_untimed("A", before), b = why_untimed("B", after);
    return a + (a.empty() || b.empty() ? "" : "; ") + b;
}

std::size_t ResultComparison::count(RowOutcome outcome) const
{
    return static_cast<std::size_t>(
        std::ranges::count_if(rows, [&](const ComparedRow& row) { return row.outcome == outcome; }));
}

std::optional<double> ResultComparison::geometric_mean() const
{
    const std::size_t compared = count(RowOutcome::compared);
    if (compared == 0) return std::nullopt;
    double sum = 0;
    for (const ComparedRow& row : rows)
        if (row.change) sum += std::log(row.change->ratio);
    return std::exp(sum / static_cast<double>(compared));
}

double ResultComparison::error() const
{
    double sum = 0;
    for (const ComparedRow& row : rows)
        if (row.change && row.change->interval) sum += row.change->error;
    return std::min(1.0, sum);
}

std::vector<const ComparedRow*> ResultComparison::regressions(bool allow_missing) const
{
    std::vector<const ComparedRow*> found;
    for (const ComparedRow& row : rows)
        if (row.outcome == RowOutcome::failed || (row.outcome == RowOutcome::missing && !allow_missing) ||
            (row.change && !row.is_noisy() && row.change->is_regression(tolerance)))
            found.push_back(&row);
    return found;
}

ResultComparison compare_results(const ResultFile& before, const ResultFile& after, const std::string& filter,
                                 double tolerance)
{
    ResultComparison comparison{&before, &after, tolerance, paired_rows(before, after, filter)};
    require_rows(before, after, comparison.rows, filter);
    find_different_work(before, after, comparison.rows);
    const std::size_t compared = comparison.count(RowOutcome::compared);
    for (ComparedRow& row : comparison.rows)
        if (row.outcome == RowOutcome::compared)
            row.change = compare_speed(row.before->samples_s, row.after->samples_s, compared, tolerance);
    const ResultHead &a = before.head, &b = after.head;
    const bool same_machine = a.machine == b.machine && a.threads == b.threads;
    for (ComparedRow& row : comparison.rows)
        if (row.change && row.change->interval)
            row.disturbance = disturbance_between(pulse_of(a, *row.before), pulse_of(b, *row.after), same_machine);
    return comparison;
}

} // namespace tetrace
