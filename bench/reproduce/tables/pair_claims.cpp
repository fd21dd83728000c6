#include "bench/reproduce/speed.h"
#include "bench/reproduce/tables/tables.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace tetrace {

namespace {

Estimate inverse(const Estimate& estimate)
{
    const auto over = [](const std::optional<double>& bound) {
        return bound ? std::optional(1 / *bound) : std::nullopt;
    };
    return {1 / estimate.value, over(estimate.high), over(estimate.low), estimate.exact};
}

/// The pairs that the paper has: the device's fastest row of the tets, and bvh2.
std::vector<RowPair> papers_pairs(const SceneRun* run, DeviceKind kind)
{
    if (run == nullptr) return {};
    auto pairs = fastest_pairs(*run);
    std::erase_if(pairs, [&](const RowPair& pair) {
        const RowRecord& bvh = run->rows[pair.bvh];
        return bvh.key.kernel.layout != Layout::bvh2 || bvh.device.kind != kind;
    });
    return pairs;
}

/// " The fastest BVH, bvh packet16 on embree, takes 0.41 of its time."; empty if the pair has it.
std::string faster_bvh_text(const RowPair& pair)
{
    const auto best = best_bvh_pair(*pair.run, pair.cdt);
    if (!best || best->bvh == pair.bvh) return {};
    std::string name = bvh_text(*best);
    name.front() = 'T';
    return fmt::format(" {}, takes {} of the time of the {}.", name, estimate_text(best->ratio.median),
                       tets_name(*pair.run));
}

bool is_noisy(const RowPair& pair)
{
    return is_noisy(pair.run->rows[pair.cdt]) || is_noisy(pair.run->rows[pair.bvh]);
}

std::string device_of(const RowPair& pair)
{
    return device_label(pair.run->rows[pair.cdt].key);
}

const char* on_text(DeviceKind kind)
{
    return kind == DeviceKind::gpu ? "a GPU" : "this CPU (the paper's claim is of a GPU)";
}

std::string no_pair_text(DeviceKind kind)
{
    return fmt::format("No {} has rates of the CDT and of bvh2", kind == DeviceKind::gpu ? "GPU" : "CPU");
}

std::string pair_evidence(const RowPair& pair)
{
    const RowRecord& cdt = pair.run->rows[pair.cdt];
    const auto cdt_frames = view_frames(*pair.run, pair.cdt), bvh_frames = view_frames(*pair.run, pair.bvh);
    const auto range = [](const std::vector<double>& frames) {
        const auto [least, most] = std::ranges::minmax_element(frames);
        return fmt::format("{:.4g} to {:.4g}", *least, *most);
    };
    return fmt::format(
        "{} {} {} against {}: the BVH's time is {} of that of the {}, median of {} views, {:.3g} to {:.3g}, above 1 "
        "in {:.1f} % of them; {} frames/s of the tets, {} of the BVH.{}",
        name_of(cdt.key.kernel.method), name_of(cdt.key.kernel.layout), device_label(cdt.key), bvh_text(pair),
        estimate_text(pair.ratio.median), tets_name(*pair.run), pair.ratio.views.size(), pair.ratio.lowest,
        pair.ratio.highest, 100 * pair.ratio.won, range(cdt_frames), range(bvh_frames), faster_bvh_text(pair));
}

/// What decides a claim: ratios that are all above 1 if it holds.
class Findings {
public:
    /// by: the pairs that the ratio is of; separator: of the evidence's items.
    void add(const Estimate& ratio, std::initializer_list<const RowPair*> by, const char* separator,
             const std::string& item)
    {
        ratios_.push_back(ratio);
        noisy_ = noisy_ || std::ranges::any_of(by, [](const RowPair* pair) { return is_noisy(*pair); });
        append_item(evidence_, separator, item);
    }
    /// without: the evidence if there are no ratios; end: of the evidence if there are. not_compared: why nothing may
    /// be decided.
    [[nodiscard]] Claim decide(Claim claim, const std::string& without, const std::string& end = "",
                               const std::string& not_compared = "") const
    {
        claim.evidence = ratios_.empty() ? without : evidence_ + end + not_compared;
        if (ratios_.empty() || !not_compared.empty()) return claim;
        claim.verdict = judge_above(ratios_, 1);
        withdraw_if_noisy(claim, noisy_);
        return claim;
    }

private:
    std::vector<Estimate> ratios_;
    std::string evidence_;
    bool noisy_ = false;
};

Claim faster_claim(const SceneRuns& runs, const paper::PairOutcome& outcome, DeviceKind kind)
{
    const char *const first = outcome.cdt_is_faster ? "CDT" : "BVH", *const second =
                                                                         outcome.cdt_is_faster ? "BVH" : "CDT";
    const Claim claim{
        fmt::format("table6-{}-is-faster-on-{}-{}", outcome.cdt_is_faster ? "cdt" : "bvh", outcome.scene,
                    name_of(kind)),
        fmt::format("on {}, the {} is faster than the {} on {}", on_text(kind), first, second, outcome.scene)};
    const SceneRun* const run = judged_run(runs, outcome.scene);
    Findings found;
    for (const RowPair& pair : papers_pairs(run, kind))
        found.add(outcome.cdt_is_faster ? pair.ratio.median : inverse(pair.ratio.median), {&pair}, " ",
                  pair_evidence(pair));
    const bool is_compared = run == nullptr || run->likeness.is_compared();
    return found.decide(claim, fmt::format("{} on {}.", no_pair_text(kind), outcome.scene), "",
                        is_compared ? "" : fmt::format(" It is {}", run->likeness.reason));
}

/// Ours, not the paper's: tets for rays are faster than the fastest BVH of the device.
Claim rays_claim(const SceneRun& run, DeviceKind kind)
{
    const Claim claim{
        fmt::format("table6-tets-for-rays-are-faster-on-{}-{}", run.build.scene, name_of(kind)),
        fmt::format("not the paper's: on {}, a walk through tets for rays is faster than the fastest BVH on {}",
                    kind == DeviceKind::gpu ? "a GPU" : "this CPU", run.build.scene)};
    Findings found;
    for (const RowPair& pair : best_bvh_pairs(run))
        if (run.rows[pair.cdt].device.kind == kind) found.add(pair.ratio.median, {&pair}, " ", pair_evidence(pair));
    return found.decide(claim, fmt::format("No {} has rates of tets for rays and of a BVH on {}.",
                                           kind == DeviceKind::gpu ? "GPU" : "CPU", run.build.scene));
}

/// Those of the paper's scenes that its claims may be decided by, in its order.
std::vector<const SceneRun*> compared_runs(const SceneRuns& runs)
{
    std::vector<const SceneRun*> found;
    for (const paper::SceneFigures& figures : paper::scenes())
        if (const SceneRun* run = judged_run(runs, figures.scene); run != nullptr && run->likeness.is_compared())
            found.push_back(run);
    return found;
}

/// The most of a row's view times over the least; and the same without the extreme view at either end, which bounds
/// how much of it is owed to single views.
struct Amplitude {
    double whole = 0, inner = 0;
};

Amplitude amplitude_of(std::vector<double> seconds)
{
    std::ranges::sort(seconds);
    return {seconds.back() / seconds.front(), seconds[seconds.size() - 2] / seconds[1]};
}

/// "The CDT's timings have the larger amplitude": its amplitude over the BVH's is above 1.
Claim amplitude_claim(const SceneRuns& runs, DeviceKind kind)
{
    const Claim claim{
        fmt::format("table6-cdt-has-the-larger-amplitude-{}", name_of(kind)),
        fmt::format("on {}, the CDT's times over the views have a larger amplitude than the BVH's", on_text(kind))};
    Findings found;
    for (const SceneRun* run : compared_runs(runs))
        for (const RowPair& pair : papers_pairs(run, kind)) {
            const auto cdt_s = view_seconds(*run, pair.cdt), bvh_s = view_seconds(*run, pair.bvh);
            const Amplitude cdt = cdt_s.size() < 3 ? Amplitude{1, 1} : amplitude_of(cdt_s),
                            bvh = cdt_s.size() < 3 ? Amplitude{1, 1} : amplitude_of(bvh_s);
            Estimate ratio{cdt.whole / bvh.whole, {}, {}, false};
            if (cdt_s.size() >= min_views && run->sampling != Sampling::chosen) {
                ratio.low = cdt.inner / bvh.whole;
                ratio.high = cdt.whole / bvh.inner;
            }
            found.add(ratio, {&pair}, "; ",
                      fmt::format("{} {}: max over min {:.3g} for the CDT, {:.3g} for bvh2", run->build.scene,
                                  device_of(pair), cdt.whole, bvh.whole));
        }
    return found.decide(claim, no_pair_text(kind) + " on a scene similar to the paper's.",
                        ". Bounds leave out the extreme view at either end.");
}

Estimate quotient(const Estimate& a, const Estimate& b)
{
    const auto over = [](const std::optional<double>& x, const std::optional<double>& y) {
        return x && y ? std::optional(*x / *y) : std::nullopt;
    };
    return {a.value / b.value, over(a.low, b.high), over(a.high, b.low), false};
}

Estimate time_ratio(const RowPair& pair)
{
    return ratio_of_sums(view_seconds(*pair.run, pair.bvh), view_seconds(*pair.run, pair.cdt), pair.run->sampling);
}

/// "The BVH's cost depends less on the size of the input": from the smallest to the largest scene the CDT's time grows
/// by more than the BVH's.
Claim size_claim(const SceneRuns& runs, DeviceKind kind)
{
    const Claim claim{
        fmt::format("table6-bvh-depends-less-on-size-{}", name_of(kind)),
        fmt::format("on {}, the BVH's cost depends less than the CDT's on the size of the input", on_text(kind))};
    const auto scenes = compared_runs(runs);
    Findings found;
    if (scenes.size() > 1)
        for (const RowPair& small : papers_pairs(scenes.front(), kind))
            for (const RowPair& large : papers_pairs(scenes.back(), kind)) {
                if (device_of(small) != device_of(large)) continue;
                const Estimate before = time_ratio(small), after = time_ratio(large);
                found.add(quotient(before, after), {&small, &large}, "; ",
                          fmt::format("{}: bvh2 takes {} of the CDT's time on {} and {} on {}", device_of(small),
                                      estimate_text(before), small.run->build.scene, estimate_text(after),
                                      large.run->build.scene));
            }
    return found.decide(claim, no_pair_text(kind) + " on two scenes similar to the paper's.", ".");
}

} // namespace

std::vector<Claim> pair_claims(const SceneRuns& runs)
{
    std::vector<Claim> claims;
    for (const DeviceKind kind : {DeviceKind::gpu, DeviceKind::cpu}) {
        for (const paper::PairOutcome& outcome : paper::outcomes())
            claims.push_back(faster_claim(runs, outcome, kind));
        claims.push_back(amplitude_claim(runs, kind));
        claims.push_back(size_claim(runs, kind));
        for (const SceneRun* run : runs)
            if (is_for_rays(*run)) claims.push_back(rays_claim(*run, kind));
    }
    return claims;
}

} // namespace tetrace
