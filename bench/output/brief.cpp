#include "bench/output/brief.h"

#include "bench/measuring/figures.h"
#include "bench/output/score.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace tetrace {

namespace {

constexpr std::size_t brief_rows = 5;

bool is_emulated(const Score& score)
{
    return score.rows.front()->device.kind == DeviceKind::emulated;
}

/// The fastest walk and the fastest BVH of each device, those of emulated devices last; then the next fastest.
std::vector<Score> most_telling(const std::vector<Score>& all)
{
    std::vector<Score> first, rest;
    std::set<std::pair<std::string, Structure>> seen;
    for (const Score& score : all) {
        if (score.mrays_per_s == 0) continue;
        const RowRecord& row = *score.rows.front();
        const std::string device = row.device.kind == DeviceKind::cpu ? "host" : device_label(row.key);
        (seen.insert({device, row.key.kernel.structure}).second ? first : rest).push_back(score);
    }
    for (std::vector<Score>* list : {&first, &rest})
        std::ranges::stable_partition(*list, [](const Score& score) { return !is_emulated(score); });
    first.insert(first.end(), rest.begin(), rest.end());
    if (first.size() > brief_rows) first.resize(brief_rows);
    std::ranges::stable_sort(first, std::ranges::greater(), &Score::mrays_per_s);
    return first;
}

std::string score_sentence(const Workload* workload, const std::vector<Score>& scores)
{
    if (workload == nullptr) return "none: the run is not of a named workload (--workload).";
    for (const Score& score : scores) // the fastest first
        if (score.is_score() && !is_emulated(score))
            return fmt::format("{} Mrays/s, {} on {}: geometric mean over {}.", score.text(), score.title(),
                               device_label(score.rows.front()->key), workload->name);
    std::map<std::string, std::size_t> reasons;
    for (const Score& score : scores)
        if (!is_emulated(score)) ++reasons[score.reason];
    const auto usual = std::ranges::max_element(reasons, {}, [](const auto& reason) { return reason.second; });
    return usual == reasons.end() ? "none: only emulated devices ran."
                                  : fmt::format("none; most often because {}.", usual->first);
}

constexpr std::size_t max_ratios = 3; // more are means

/// "bunny 1.84 [1.80, 1.88] of bvh stream; atrium ...": the fastest walk's rate over the fastest BVH's in each contest.
std::string ratios_text(const std::vector<Contest<RowRecord>>& contests)
{
    std::vector<std::string> parts;
    for (const auto& contest : contests) {
        const RowRecord *const walk = contest.fastest(Walk::any), *const bvh = contest.fastest(Rival::any);
        if (walk == nullptr || bvh == nullptr) continue;
        const Comparison comparison = compare_rates(*bvh, *walk);
        const bool noisy = figures_of(*walk)->noisy || figures_of(*bvh)->noisy;
        parts.push_back(fmt::format("{} {:.2f} {}{} of {}", rays_title(walk->key), comparison.ratio,
                                    interval_text(comparison), noisy ? " noisy" : "", kernel_title(bvh->key)));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

/// "primary rays 1.08, diffuse rays 0.71": geometric means over the contests of a kind of rays.
std::string means_text(const std::vector<Contest<RowRecord>>& contests)
{
    std::map<RayKind, std::vector<double>> logarithms;
    for (const auto& contest : contests) {
        const RowRecord *const walk = contest.fastest(Walk::any), *const bvh = contest.fastest(Rival::any);
        if (walk != nullptr && bvh != nullptr)
            logarithms[walk->key.rays].push_back(std::log(compare_rates(*bvh, *walk).ratio));
    }
    std::vector<std::string> parts;
    for (const auto& [kind, list] : logarithms)
        parts.push_back(
            fmt::format("{} rays {:.2f}", name_of(kind),
                        std::exp(std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size()))));
    return fmt::format("{}{}", fmt::join(parts, ", "), parts.empty() ? "" : " (geometric means)");
}

std::string compared_text(const BenchResult& result)
{
    std::vector<const RowRecord*> ranked;
    for (const RowRecord& row : result.rows)
        if (figures_of(row) && row.device.kind != DeviceKind::emulated && row.key.threads == 0) ranked.push_back(&row);
    const auto contests = contests_of(ranked);
    const std::string all = contests.size() > max_ratios ? means_text(contests) : ratios_text(contests);
    return all.empty() ? std::string() : "rate of the fastest walk over that of the fastest BVH: " + all + ".";
}

/// All rows without a rate in one sentence.
std::string without_rate(const std::vector<RowRecord>& rows)
{
    std::map<Status, std::size_t> counts;
    const RowRecord* first = nullptr;
    for (const RowRecord& row : rows) {
        if (has_answers(row)) continue;
        ++counts[status_of(row)];
        if (first == nullptr || status_of(row) > status_of(*first)) first = &row; // errors matter most
    }
    if (first == nullptr) return {};
    std::vector<std::string> parts;
    for (const auto& [status, count] : counts)
        parts.push_back(fmt::format("{} {}", counted(count, "row", "rows"), name_of(status)));
    std::string reason = reason_of(*first);
    reason = reason.substr(0, reason.find('\n'));
    if (reason.size() > 100) {
        std::size_t end = 97;
        while ((static_cast<unsigned char>(reason[end]) & 0xC0u) == 0x80u) // within a character of UTF-8
            --end;
        reason = reason.substr(0, end) + "...";
    }
    return fmt::format("{}; for example {}: {}", fmt::join(parts, ", "), row_label(first->key), reason);
}

} // namespace

std::string machine_sentence(const ResultValue& section)
{
    const ResultValue host = section.at("host");
    const auto label = section.find("label");
    return fmt::format("{}, {} threads, {}; tetrace {} ({}).", label ? label->line() : host.at("cpu").line(),
                       section.at("threads").count(), host.at("system").line(), section.at("version").line(),
                       section.at("commit").line());
}

Sheet brief_sheet(const BenchResult& result)
{
    const Workload* const workload = workload_of(result.scenes, result.rows);
    const std::vector<Score> scores = scores_of(workload, result.rows);
    Sheet sheet;
    sheet.table(score_table(most_telling(scores), false));
    sheet.gap();
    sheet.labelled("Score", score_sentence(workload, scores));
    sheet.labelled("No rate", without_rate(result.rows));
    if (result.interrupted) sheet.labelled("Stopped", interrupted_sentence);
    sheet.labelled("Compared", compared_text(result));
    if (is_timed(result)) sheet.labelled("Trust", trust_text(steadiness_of(result)));
    return sheet;
}

} // namespace tetrace
