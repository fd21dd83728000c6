#include "bench/reproduce/speed.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace tetrace {

namespace {

/// Numbers of a row's views, such as their correlation and their line's intercept.
using Numbers = std::vector<Estimate>;
/// From the tets per ray and the seconds of each view, of which there are enough.
using NumbersOfViews =
    std::function<Numbers(const std::vector<double>& steps, const std::vector<double>& seconds, Sampling sampling)>;

/// A claim about each row of maria, the paper's method, on a device of a kind.
struct ClaimOfRows {
    Claim claim;
    NumbersOfViews numbers_of;
    std::function<std::string(const Numbers&)> text_of;
    std::function<ClaimVerdict(const std::vector<Numbers>&)> judge;
    std::string rule; ///< a sentence
};

const char* device_text(DeviceKind kind)
{
    return kind == DeviceKind::gpu ? "GPU" : "CPU";
}

/// The numbers of one place in each row's list.
std::vector<Estimate> column(const std::vector<Numbers>& rows, std::size_t place)
{
    std::vector<Estimate> list;
    for (const Numbers& row : rows)
        list.push_back(row.at(place));
    return list;
}

Claim decided(const ClaimOfRows& what, const RecordedRuns& runs, DeviceKind kind)
{
    Claim claim = what.claim;
    std::vector<Numbers> rows;
    bool noisy = false, is_short = false;
    for (const RecordedRows* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i) {
            const RowRecord& row = run->rows[i];
            const auto seconds = view_seconds(*run, i);
            if (row.key.kernel.method != Method::maria || row.device.kind != kind || seconds.empty()) continue;
            const auto steps = view_steps(*run, i);
            if (!correlation(steps, seconds, run->sampling)) {
                is_short = true;
                continue;
            }
            noisy = noisy || is_noisy(row);
            rows.push_back(what.numbers_of(steps, seconds, run->sampling));
            append_item(claim.evidence, "; ", fmt::format("{}: {}", series_name(row), what.text_of(rows.back())));
        }
    if (is_short) {
        claim.evidence = fmt::format("It takes {} views that differ.", min_views);
        return claim;
    }
    if (rows.empty()) {
        claim.evidence = fmt::format("No row of maria has a rate on a {}.", device_text(kind));
        return claim;
    }
    claim.verdict = what.judge(rows);
    claim.evidence += ". " + what.rule;
    withdraw_if_noisy(claim, noisy);
    return claim;
}

} // namespace

Claim proportional_claim(const RecordedRuns& runs, DeviceKind kind)
{
    return decided(
        {{fmt::format("time-is-proportional-to-tets-{}", name_of(kind)),
          fmt::format("the time of maria is proportional to the tets traversed, on a {}", device_text(kind))},
         [](const auto& steps, const auto& seconds, Sampling sampling) -> Numbers {
             return {correlation(steps, seconds, sampling).value(), intercept_share(steps, seconds, sampling)};
         },
         [](const Numbers& row) {
             return fmt::format("r = {}, at 0 tets {} of the mean time", estimate_text(row[0]), estimate_text(row[1]));
         },
         [](const std::vector<Numbers>& rows) {
             return judge_both(judge_above(column(rows, 0), proportional_above),
                               judge_within(column(rows, 1), proportional_intercept));
         },
         fmt::format("Proportional: r above {}, and at 0 tets at most {} of the mean time.", proportional_above,
                     proportional_intercept)},
        runs, kind);
}

Claim linear_claim(const RecordedRuns& runs, DeviceKind kind)
{
    return decided({{fmt::format("time-is-linear-in-tets-{}", name_of(kind)),
                     fmt::format("the time of maria is linear in the tets traversed, on a {}", device_text(kind))},
                    [](const auto& steps, const auto& seconds, Sampling sampling) -> Numbers {
                        return {correlation(steps, seconds, sampling).value()};
                    },
                    [](const Numbers& row) { return fmt::format("r = {}", estimate_text(row[0])); },
                    [](const std::vector<Numbers>& rows) { return judge_above(column(rows, 0), proportional_above); },
                    fmt::format("Linear: r above {}.", proportional_above)},
                   runs, kind);
}

Claim slower_tets_claim(const RecordedRuns& runs, DeviceKind kind)
{
    const auto seconds_a_tet = [](const std::vector<double>& steps, const std::vector<double>& seconds) {
        std::vector<double> each;
        for (std::size_t view = 0; view < steps.size(); ++view)
            each.push_back(seconds[view] / steps[view]);
        return each;
    };
    return decided(
        {{fmt::format("a-tet-takes-longer-where-more-are-traversed-{}", name_of(kind)),
          fmt::format("a tet of maria takes longer in views that traverse more tets, on a {}", device_text(kind))},
         [&](const auto& steps, const auto& seconds, Sampling sampling) -> Numbers {
             return {correlation(steps, seconds_a_tet(steps, seconds), sampling).value_or(Estimate{})};
         },
         [](const Numbers& row) {
             return fmt::format("r of a tet's time and their number = {}", estimate_text(row[0]));
         },
         [](const std::vector<Numbers>& rows) { return judge_above(column(rows, 0), 0); },
         "The paper gives cache misses as the reason."},
        runs, kind);
}

} // namespace tetrace
