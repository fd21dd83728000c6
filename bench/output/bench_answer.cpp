#include "bench/output/bench_report.h"

#include "bench/measuring/figures.h"
#include "bench/statistics/statistics.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace tetrace {

namespace {

/// Rows that may be ranked with each other: the same rays on one piece of hardware, in any structure and layout.
struct Contest {
    const RowRecord* any = nullptr;
    std::vector<const RowRecord*> rows; ///< timed ones

    [[nodiscard]] const RowRecord& fastest() const
    {
        return **std::ranges::max_element(rows, {}, [](const RowRecord* row) { return rate_of(*row); });
    }
    [[nodiscard]] static double rate_of(const RowRecord& row) { return figures_of(row)->mrays_per_s; }
};

/// Emulated devices are in none: they are not to be ranked.
std::vector<Contest> contests_of(const BenchResult& result)
{
    std::vector<Contest> contests;
    const auto hardware_of = [&](const RowRecord& row) {
        return result.devices.at(*device_of(row, result.devices)).hardware;
    };
    for (const RowRecord& row : result.rows) {
        if (!figures_of(row) || !device_of(row, result.devices) || row.device.kind == DeviceKind::emulated) continue;
        const auto same = std::ranges::find_if(contests, [&](const Contest& other) {
            return same_rays(other.any->key, row.key) && hardware_of(*other.any) == hardware_of(row);
        });
        (same == contests.end() ? contests.emplace_back(Contest{&row, {}}) : *same).rows.push_back(&row);
    }
    return contests;
}

/// "bunny", "bunny, shadow rays", with the device where there are several.
std::string contest_title(const Contest& contest, bool with_device)
{
    const RowKey& key = contest.any->key;
    std::string title = key.scene;
    if (key.rays != RayKind::primary) title += fmt::format(", {} rays", name_of(key.rays));
    if (key.ray_order != RayOrder::tiles) title += fmt::format(" {}", name_of(key.ray_order));
    return with_device ? fmt::format("{} ({})", title, contest.any->device.name) : title;
}

std::string row_text(const RowRecord& row)
{
    std::string remarks;
    if (status_of(row) == Status::flawed) remarks = "flawed";
    if (figures_of(row)->noisy) remarks += remarks.empty() ? "noisy" : ", noisy";
    return row_label(row.key) + (remarks.empty() ? "" : " (" + remarks + ")");
}

/// One phrase for each contest, from those that have something to tell.
template <class Phrase>
std::string joined(const std::vector<Contest>& contests, const Phrase& phrase)
{
    const bool with_device = std::ranges::any_of(contests, [&](const Contest& contest) {
        return contest.any->device.name != contests.front().any->device.name;
    });
    std::vector<std::string> parts;
    for (const Contest& contest : contests)
        if (const std::string text = phrase(contest); !text.empty())
            parts.push_back(contest_title(contest, with_device) + ": " + text);
    return fmt::format("{}", fmt::join(parts, "; "));
}

/// The rows of a contest, all in one arena.
std::vector<Contender> contenders_of(const Contest& contest)
{
    std::vector<Contender> list;
    for (const RowRecord* row : contest.rows) {
        const KernelId& kernel = row->key.kernel;
        list.push_back({row_text(*row), "", kernel.structure == Structure::bvh, is_embree(kernel.layout),
                        is_single_ray(kernel), Contest::rate_of(*row)});
    }
    return list;
}

/// The fastest walk through tets, of all or of those that trace one ray at a time.
std::optional<std::size_t> best_walk(const std::vector<Contender>& rows, bool single)
{
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!rows[i].is_bvh && (rows[i].is_single || !single) &&
            (!best || rows[i].mrays_per_s > rows[*best].mrays_per_s))
            best = i;
    return best;
}

/// "1.84 [1.80, 1.88] of the rate of the fastest BVH, bvh packet16 on embree". rows: of the contest.
std::string over_bvh_text(const Contest& contest, const std::vector<Contender>& rows, std::size_t walk, std::size_t bvh)
{
    const Comparison comparison = compare_rates(*contest.rows[bvh], *contest.rows[walk]);
    const std::string interval = interval_text(comparison);
    return fmt::format("{:.2f}{} of the rate of {}", comparison.ratio, interval.empty() ? "" : " " + interval,
                       bvh_text(rows, bvh));
}

/// One ray at a time, over our fastest such BVH and over Embree's single rays; empty if all rows are ours and do so.
std::string single_text(const Contest& contest, const std::vector<Contender>& rows)
{
    if (std::ranges::all_of(rows, [](const Contender& row) { return row.is_single && !row.is_embree; })) return {};
    const auto walk = best_walk(rows, true);
    if (!walk) return {};
    std::vector<std::string> parts;
    for (const BvhKind kind : {BvhKind::our_single, BvhKind::embree_single})
        if (const auto bvh = best_bvh(rows, *walk, kind)) parts.push_back(over_bvh_text(contest, rows, *walk, *bvh));
    if (parts.empty()) return {};
    return fmt::format("; one ray at a time, {} has {}", rows[*walk].name, fmt::join(parts, " and "));
}

std::string structures_text(const std::vector<Contest>& contests)
{
    return joined(contests, [](const Contest& contest) -> std::string {
        const auto rows = contenders_of(contest);
        const auto walk = best_walk(rows, false), bvh = walk ? best_bvh(rows, *walk) : std::nullopt;
        if (!bvh) return {};
        return fmt::format("the fastest walk through tets, {}, has {}{}", rows[*walk].name,
                           over_bvh_text(contest, rows, *walk, *bvh), single_text(contest, rows));
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

std::string load_text(const std::optional<MachineLoad>& load)
{
    if (!load) return "the load while measuring is not known";
    return fmt::format("other processes used {:.2f} of {} CPUs while measuring, load average {:.1f}", load->others,
                       load->processors, load->average);
}

std::string pulses_text(const std::vector<Pulse>& pulses)
{
    std::string text;
    for (const Pulse& pulse : pulses)
        text += fmt::format("; calibration of {}: {} runs, slowest {:.2f}x the fastest",
                            pulse.of == "host" ? "the host" : pulse.of, pulse.readings.size(), pulse.ratio());
    return text;
}

} // namespace

Sheet answer_of(const BenchResult& result)
{
    const auto contests = contests_of(result);
    Sheet sheet;
    if (!contests.empty())
        sheet.labelled("Fastest", joined(contests, [](const Contest& contest) {
                                      const RowRecord& best = contest.fastest();
                                      return fmt::format("{}, {:.1f} Mrays/s", row_text(best), Contest::rate_of(best));
                                  }) + ".");
    std::string compared = structures_text(contests);
    if (const std::string apis = apis_text(result); !apis.empty()) compared += (compared.empty() ? "" : ". ") + apis;
    if (!compared.empty()) sheet.labelled("Compared", compared + ".");
    if (is_timed(result)) {
        Steadiness steadiness{result.measurement.load, result.measurement.pulses};
        for (const RowRecord& row : result.rows)
            steadiness.count(row);
        sheet.labelled("Trust", trust_text(steadiness));
    }
    return sheet;
}

void Steadiness::count(const RowRecord& row)
{
    const auto figures = figures_of(row);
    if (!figures) return;
    ++timed;
    noisy += figures->noisy ? 1 : 0;
    disturbed += row.disturbance.empty() ? 0 : 1;
}

std::string trust_text(const Steadiness& all)
{
    const std::string what =
        fmt::format("{}{}; {} of {} rows noisy", load_text(all.load), pulses_text(all.pulses), all.noisy, all.timed);
    if (all.disturbed == all.timed || (all.load && !all.load->is_quiet()))
        return what + ": do not trust these rates; measure again on a quieter machine.";
    if (all.disturbed > 0) return what + ": do not trust the noisy ones; measure again on a quieter machine.";
    return what + (2 * all.noisy > all.timed ? ": trust only differences that the intervals confirm." : ".");
}

} // namespace tetrace
