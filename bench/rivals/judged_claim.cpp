#include "bench/rivals/judged_claim.h"

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace tetrace {

namespace {

/// Also if the scene could not be loaded.
bool may_have_tets(const RivalContest& contest, TetsKind kind)
{
    return !contest.scene || contest.scene->tets == kind;
}

/// Of that name, and seen as the catalogue's scene is: a file of the user's may have its name.
bool is_the_scene(const RivalContest& contest, std::string_view name)
{
    const auto scene = std::ranges::find(rival_scenes(), name, &RivalScene::name);
    const bool has_views = scene != rival_scenes().end() && scene->has_own_views;
    return is_scene(contest.key.scene, name) && (!contest.scene || has_views == contest.scene->has_own_views);
}

bool is_about(const RivalClaim& claim, const RivalContest& contest)
{
    const auto is_it = [&](std::string_view name) { return is_the_scene(contest, name); };
    return contest.place == claim.place && std::ranges::find(claim.rays, contest.key.rays) != claim.rays.end() &&
           (claim.scenes.empty() || std::ranges::any_of(claim.scenes, is_it)) &&
           (claim.backend.empty() || contest.key.backend == claim.backend) &&
           (!claim.tets || may_have_tets(contest, *claim.tets));
}

/// Why the rows lack a rate; empty if one has a rate, or without rows.
std::string reason_without_rate(const std::vector<const RowRecord*>& rows)
{
    if (rows.empty() || fastest(rows) != nullptr) return {};
    const RowRecord& first = *rows.front();
    const Status status = status_of(first);
    return status == Status::ok || status == Status::flawed ? std::string("not timed")
                                                            : fmt::format("{}: {}", name_of(status), reason_of(first));
}

bool is_noisy_row(const RowRecord& row)
{
    return figures_of(row)->noisy;
}

/// "They are slower": a faster rival speaks for the claim, a faster walk against it.
bool wants_slow_walks(const RivalClaim& claim)
{
    return claim.is_below && claim.measure == Measure::rate;
}

/// A walk that was not timed could be the fastest. Only one could, if the claim names its kernel.
void add_untimed_walks(JudgedClaim& judged, const RivalContest& contest)
{
    for (const RowRecord* row : contest.of(judged.claim->walk)) {
        if (figures_of(*row) || status_of(*row) == Status::unsupported) continue;
        judged.obstacles.push_back(fmt::format("{}: no rate of {}, which could be faster: {}", rays_title(contest.key),
                                               row_label(row->key), reason_without_rate({row})));
        judged.may_refute = judged.may_refute && wants_slow_walks(*judged.claim);
    }
}

/// A rival that the device has, but that was not timed, could be the fastest.
void add_untimed_rivals(JudgedClaim& judged, const RivalContest& contest)
{
    const std::size_t before = judged.obstacles.size();
    for (const RowRecord* row : contest.of(judged.claim->rival))
        if (!figures_of(*row) && status_of(*row) != Status::unsupported)
            judged.obstacles.push_back(fmt::format("{}: no rate of {}, which could be faster: {}",
                                                   rays_title(contest.key), row_label(row->key),
                                                   reason_without_rate({row})));
    const bool needs_embree = contest.place == DeviceKind::cpu && judged.claim->rival != Rival::our_single;
    if (needs_embree &&
        std::ranges::none_of(contest.rows, [](const RowRecord* row) { return is_embree(row->key.kernel.layout); }))
        judged.obstacles.push_back(
            fmt::format("{}: Embree, whose rays could be faster, has no rows in this run", rays_title(contest.key)));
    if (judged.obstacles.size() > before && wants_slow_walks(*judged.claim)) judged.may_refute = false;
}

void add_contest(JudgedClaim& judged, const RivalContest& contest)
{
    const auto walks = contest.of(judged.claim->walk), rivals = contest.of(judged.claim->rival);
    const RowRecord *const walk = fastest(walks), *const rival = fastest(rivals);
    const auto add_missing = [&](std::string_view what, const std::vector<const RowRecord*>& rows) {
        const std::string reason = rows.empty() ? "no such row was selected" : reason_without_rate(rows);
        judged.obstacles.push_back(fmt::format("{}: no rate of {}: {}", rays_title(contest.key), what, reason));
    };
    if (walk == nullptr) add_missing(name_of(judged.claim->walk), walks);
    if (rival == nullptr) add_missing(name_of(judged.claim->rival), rivals);
    if (walk == nullptr || rival == nullptr) return;
    add_untimed_walks(judged, contest);
    add_untimed_rivals(judged, contest);
    const auto value = judged.claim->measure == Measure::rate ? std::optional(rate_ratio(*walk, *rival))
                                                              : tracing_until_paid(*walk, *rival);
    if (!value) {
        judged.obstacles.push_back(fmt::format("{}: a build time is not known", rays_title(contest.key)));
        return;
    }
    judged.numbers.push_back({&contest, walk, rival, *value});
    for (const RowRecord* row : {walk, rival})
        if (is_noisy_row(*row))
            judged.obstacles.push_back(fmt::format("{}: {} is noisy, so measure again on a quieter machine",
                                                   rays_title(contest.key), row_label(row->key)));
}

void add_missing_scenes(JudgedClaim& judged, const std::vector<const RivalContest*>& contests)
{
    for (const std::string_view name : judged.claim->scenes)
        if (std::ranges::none_of(contests, [&](const RivalContest* contest) { return is_the_scene(*contest, name); }))
            judged.missing.emplace_back(name);
    if (contests.empty() && judged.missing.empty())
        judged.obstacles.emplace_back("no row of this run is on such a device, with such rays");
}

void add_left_out(JudgedClaim& judged, const LeftOut& left_out)
{
    const RivalClaim& claim = *judged.claim;
    if (left_out.kernels) {
        judged.obstacles.emplace_back("options left out kernels; one of them could be the fastest");
        const bool has_several_walks =
            claim.walk == Walk::single || claim.walk == Walk::any || claim.walk == Walk::maria;
        if (has_several_walks || wants_slow_walks(claim)) judged.may_refute = false;
    }
    if (left_out.apis && claim.place == DeviceKind::gpu) {
        judged.obstacles.emplace_back(
            "--backend or --device left out an API of the GPU; one of its rows could be the fastest");
        judged.may_refute = false;
    }
}

/// Rows that the claim is about, and that --filter left out. One of them could be the fastest.
void add_filtered(JudgedClaim& judged, const std::vector<RowKey>& filtered)
{
    const RivalClaim& claim = *judged.claim;
    const RowKey* first = nullptr;
    std::size_t count = 0;
    for (const RowKey& key : filtered) {
        const bool is_walk = is_of(key.kernel, claim.walk), is_rival = is_of(key.kernel, claim.rival);
        const DeviceKind place = backend_named(key.backend).devices().at(key.device).kind;
        if ((!is_walk && !is_rival) || !is_about(claim, {{}, key, place, {}})) continue;
        if (count++ == 0) first = &key;
        if (is_walk != wants_slow_walks(claim)) judged.may_refute = false;
    }
    if (count == 0) return;
    judged.obstacles.push_back(fmt::format("--filter left out {} that it is about, such as {} for {}",
                                           counted(count, "row", "rows"), row_label(*first), rays_title(*first)));
}

/// The measure such that more of it speaks for the claim.
Estimate in_favour(const RivalClaim& claim, const Estimate& value)
{
    if (!claim.is_below) return value;
    const auto negated = [](const std::optional<double>& bound) {
        return bound ? std::optional(-*bound) : std::nullopt;
    };
    return {-value.value, negated(value.high), negated(value.low), value.exact};
}

ClaimVerdict verdict_of(const JudgedClaim& judged, bool of_noisy_rows_too)
{
    std::vector<Estimate> values;
    for (const ClaimNumber& one : judged.numbers)
        if (of_noisy_rows_too || (!is_noisy_row(*one.walk) && !is_noisy_row(*one.rival)))
            values.push_back(in_favour(*judged.claim, one.value));
    const double boundary = judged.claim->boundary;
    return judge_above(values, judged.claim->is_below ? -boundary : boundary);
}

std::string place_text(const RivalClaim& claim)
{
    switch (claim.place) {
    case DeviceKind::cpu: return "on the CPU";
    case DeviceKind::gpu: return "on each GPU";
    case DeviceKind::emulated: return fmt::format("on {} if that is emulated on the CPU", claim.backend);
    }
    return {};
}

/// "cdt project half32 packets on openmp (203 Mrays/s, noisy)". Precondition: the row has a rate.
std::string rated_label(const RowRecord& row)
{
    const std::string remarks = remarks_on(row);
    return fmt::format("{} ({:.4g} Mrays/s{}{})", row_label(row.key), *mrays_of(row), remarks.empty() ? "" : ", ",
                       remarks);
}

std::string names_of(const std::vector<RayKind>& kinds)
{
    std::vector<std::string_view> names;
    for (const RayKind kind : kinds)
        names.push_back(name_of(kind));
    return fmt::format("{}", fmt::join(names, ", "));
}

} // namespace

std::vector<ContestScene> contest_scenes(const std::vector<nlohmann::json>& scenes)
{
    std::vector<ContestScene> found;
    for (const nlohmann::json& scene : scenes)
        found.push_back({scene.at("name"),
                         scene.at("tets_kind") == name_of(TetsKind::rays) ? TetsKind::rays : TetsKind::cdt,
                         scene.contains("own_views")});
    return found;
}

std::vector<RivalContest> rival_contests(const std::vector<RowRecord>& rows, const std::vector<ContestScene>& scenes)
{
    std::vector<const RowRecord*> exact;
    for (const RowRecord& row : rows)
        if (!is_portable(row.key.kernel) || row.key.kernel.math == MathMode::exact) exact.push_back(&row);
    std::vector<RivalContest> contests;
    for (auto& contest : contests_of(exact)) {
        const RowRecord& first = *contest.rows.front();
        const DeviceKind place = first.device.name.empty() ? DeviceKind::cpu : first.device.kind;
        contests.push_back({std::move(contest), first.key, place, {}});
        const auto scene = std::ranges::find(scenes, first.key.scene, &ContestScene::name);
        if (scene != scenes.end()) contests.back().scene = *scene;
    }
    return contests;
}

Estimate rate_ratio(const RowRecord& row, const RowRecord& over)
{
    const Comparison comparison = compare_rates(over, row);
    Estimate estimate{comparison.ratio, {}, {}};
    if (comparison.interval) {
        estimate.low = comparison.interval->low;
        estimate.high = comparison.interval->high;
    }
    return estimate;
}

JudgedClaim judge(const RivalClaim& claim, const std::vector<RivalContest>& contests, const LeftOut& left_out)
{
    JudgedClaim judged;
    judged.claim = &claim;
    std::vector<const RivalContest*> about;
    for (const RivalContest& contest : contests)
        if (is_about(claim, contest)) about.push_back(&contest);
    add_missing_scenes(judged, about);
    add_filtered(judged, left_out.filtered);
    for (const RivalContest* contest : about)
        add_contest(judged, *contest);
    if (!judged.numbers.empty()) add_left_out(judged, left_out);
    if (judged.may_refute && verdict_of(judged, false) == ClaimVerdict::does_not_hold)
        judged.verdict = ClaimVerdict::does_not_hold;
    else if (judged.obstacles.empty())
        judged.verdict = verdict_of(judged, true);
    return judged;
}

std::string number_text(const RivalClaim& claim, const Estimate& value)
{
    if (std::isinf(value.value)) return "never";
    const auto text = [](double number) { return std::isinf(number) ? "never" : fmt::format("{:.2f}", number); };
    const std::string interval =
        value.low && value.high ? fmt::format(" [{}, {}]", text(*value.low), text(*value.high)) : std::string();
    return text(value.value) + interval + (claim.measure == Measure::break_even ? " s" : "");
}

std::string rule_of(const RivalClaim& claim)
{
    const char* const side = claim.is_below ? "below" : "above";
    const std::string what =
        claim.measure == Measure::rate
            ? fmt::format("the rate of {} over that of {} is {} {:.4g}", name_of(claim.walk), name_of(claim.rival),
                          side, claim.boundary)
            : fmt::format("the seconds of tracing by {} until the tets' build has paid off, against {}, are {} {:.4g}",
                          name_of(claim.walk), name_of(claim.rival), side, claim.boundary);
    return fmt::format("{} {}, for {} rays of {}", what, place_text(claim), names_of(claim.rays),
                       claim.scenes.empty() ? std::string("every scene")
                                            : fmt::format("{}", fmt::join(claim.scenes, ", ")));
}

Claim to_claim(const JudgedClaim& judged)
{
    const RivalClaim& claim = *judged.claim;
    Claim result{std::string(claim.id), fmt::format("{} ({})", claim.text, claim.made_in), judged.verdict,
                 fmt::format("Then {} ({}).", claim.then, claim.old->name)};
    for (const ClaimNumber& one : judged.numbers)
        result.evidence += fmt::format("{} {} {}", &one == judged.numbers.data() ? " Now" : ",",
                                       number_text(claim, one.value), rays_title(one.contest->key));
    result.evidence += fmt::format("{} It holds if {}.", judged.numbers.empty() ? "" : ".", rule_of(claim));
    for (const ClaimNumber& one : judged.numbers)
        result.evidence += fmt::format(" {}: {} over {}.", rays_title(one.contest->key), rated_label(*one.walk),
                                       rated_label(*one.rival));
    for (const std::string& obstacle : judged.obstacles)
        result.evidence += fmt::format(" {}.", obstacle);
    if (!judged.missing.empty())
        result.evidence += fmt::format(" Not traced in this run: {}.", fmt::join(judged.missing, ", "));
    return result;
}

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

double seconds_until_paid(double more_s, double ratio)
{
    if (more_s <= 0 && ratio >= 1) return 0;
    return ratio > 1 ? more_s / (ratio - 1) : never;
}

std::optional<Estimate> tracing_until_paid(const RowRecord& walk, const RowRecord& other)
{
    const auto ours = setup_cost(walk), others = setup_cost(other);
    if (!ours || !others) return std::nullopt;
    const double more_s = ours->once_s() - others->once_s();
    const Estimate ratio = rate_ratio(walk, other);
    Estimate seconds{seconds_until_paid(more_s, ratio.value), {}, {}};
    if (ratio.low && ratio.high) {
        seconds.low = seconds_until_paid(more_s, *ratio.high);
        seconds.high = seconds_until_paid(more_s, *ratio.low);
    }
    return seconds;
}

} // namespace tetrace
