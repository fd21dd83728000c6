#include "bench/output/bench_report.h"

#include "bench/measuring/figures.h"
#include "bench/statistics/statistics.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace tetrace {

namespace {

using RowContest = Contest<RowRecord>;

/// Of timed rows. Emulated devices are in none: they are not to be ranked. Nor are rows with fewer threads than others.
std::vector<RowContest> ranked_contests(const BenchResult& result)
{
    std::vector<const RowRecord*> ranked;
    for (const RowRecord& row : result.rows)
        if (figures_of(row) && row.device.kind != DeviceKind::emulated && row.key.threads == 0) ranked.push_back(&row);
    return contests_of(ranked);
}

const RowRecord& first_of(const RowContest& contest)
{
    return *contest.rows.front();
}

/// "bunny", "bunny, shadow rays", with the device if there are several.
std::string contest_title(const RowContest& contest, bool with_device)
{
    const std::string title = rays_title(first_of(contest).key);
    return with_device ? fmt::format("{} ({})", title, first_of(contest).device.name) : title;
}

std::string row_text(const RowRecord& row)
{
    const std::string remarks = remarks_on(row);
    return row_label(row.key) + (remarks.empty() ? "" : " (" + remarks + ")");
}

/// One phrase for each contest, from those that have something to tell.
template <class Phrase>
std::string joined(const std::vector<RowContest>& contests, const Phrase& phrase)
{
    const bool with_device = std::ranges::any_of(contests, [&](const RowContest& contest) {
        return first_of(contest).device.name != first_of(contests.front()).device.name;
    });
    std::vector<std::string> parts;
    for (const RowContest& contest : contests)
        if (const std::string text = phrase(contest); !text.empty())
            parts.push_back(contest_title(contest, with_device) + ": " + text);
    return fmt::format("{}", fmt::join(parts, "; "));
}

/// "1.84 [1.80, 1.88] of the rate of the fastest BVH, bvh packet16 on embree".
std::string over_bvh_text(const RowContest& contest, const RowRecord& walk, const RowRecord& bvh)
{
    const Comparison comparison = compare_rates(bvh, walk);
    const std::string interval = interval_text(comparison);
    return fmt::format("{:.2f}{} of the rate of {}", comparison.ratio, interval.empty() ? "" : " " + interval,
                       contest.bvh_text(bvh, row_text(bvh)));
}

/// One ray at a time, over our fastest such BVH and over Embree's single rays; empty if all rows are ours and do so.
std::string single_text(const RowContest& contest)
{
    if (std::ranges::all_of(contest.rows, [](const RowRecord* row) {
            return is_single_ray(row->key.kernel) && !is_embree(row->key.kernel.layout);
        }))
        return {};
    const RowRecord* const walk = contest.fastest(Walk::single);
    if (walk == nullptr) return {};
    std::vector<std::string> parts;
    for (const Rival kind : {Rival::our_single, Rival::embree_single})
        if (const RowRecord* const bvh = contest.fastest(kind)) parts.push_back(over_bvh_text(contest, *walk, *bvh));
    if (parts.empty()) return {};
    return fmt::format("; one ray at a time, {} has {}", row_text(*walk), fmt::join(parts, " and "));
}

std::string structures_text(const std::vector<RowContest>& contests)
{
    return joined(contests, [](const RowContest& contest) -> std::string {
        const RowRecord *const walk = contest.fastest(Walk::any), *const bvh = contest.fastest(Rival::any);
        if (walk == nullptr || bvh == nullptr) return {};
        return fmt::format("the fastest walk through tets, {}, has {}{}", row_text(*walk),
                           over_bvh_text(contest, *walk, *bvh), single_text(contest));
    });
}

/// The median of each API's ratios to its reference, on the same hardware.
std::string apis_text(const BenchResult& result)
{
    std::map<std::string, std::map<std::string, std::vector<double>>> ratios;
    for (std::size_t i = 0; i < result.rows.size(); ++i)
        if (const auto& comparison = result.comparisons.at(i)) {
            const std::string &row = result.rows[i].key.backend, &reference = comparison->reference->key.backend;
            if (row != reference) ratios[reference][row].push_back(comparison->ratio);
        }
    std::vector<std::string> parts;
    for (const auto& [reference, apis] : ratios) {
        std::vector<std::string> of_one;
        for (const auto& [api, list] : apis)
            of_one.push_back(fmt::format("{} {:.2f}", api, quantile(list, 0.5)));
        parts.push_back(
            fmt::format("APIs by {}'s rate, medians over the kernels: {}", reference, fmt::join(of_one, ", ")));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

} // namespace

Steadiness steadiness_of(const BenchResult& result)
{
    Steadiness steadiness{result.measurement.load, result.measurement.pulses, result.conditions};
    for (const RowRecord& row : result.rows)
        steadiness.count(row);
    return steadiness;
}

Sheet answer_of(const BenchResult& result)
{
    const auto contests = ranked_contests(result);
    Sheet sheet;
    if (!contests.empty())
        sheet.labelled("Fastest", joined(contests, [](const RowContest& contest) {
                                      const RowRecord& best = *fastest(contest.rows);
                                      return fmt::format("{}, {:.1f} Mrays/s", row_text(best), *mrays_of(best));
                                  }) + ".");
    std::string compared = structures_text(contests);
    if (const std::string apis = apis_text(result); !apis.empty()) compared += (compared.empty() ? "" : ". ") + apis;
    if (!compared.empty()) sheet.labelled("Compared", compared + ".");
    if (is_timed(result)) sheet.labelled("Trust", trust_text(steadiness_of(result)));
    return sheet;
}

} // namespace tetrace
