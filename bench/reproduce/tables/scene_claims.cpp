#include "bench/measuring/figures.h"
#include "bench/reproduce/speed.h"
#include "bench/reproduce/tables/tables.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// A rate with the quartiles of its samples as bounds.
struct BestRate {
    Estimate mrays;
    bool noisy = false;
};

/// Of maria's fastest row of the run on a device of that kind.
std::optional<BestRate> best_rate(const SceneRun& run, paper::Place place)
{
    std::optional<BestRate> best;
    for (const RowRecord& row : run.rows) {
        if (row.key.kernel.method != Method::maria || paper_place(row) != place) continue;
        const auto figures = figures_of(row);
        if (!figures || (best && best->mrays.value >= figures->mrays_per_s)) continue;
        const Statistics& times = figures->kernel_s;
        const double rays = figures->mrays_per_s * times.median;
        best = BestRate{{figures->mrays_per_s, rays / times.upper_quartile, rays / times.lower_quartile, false},
                        times.noisy()};
    }
    return best;
}

std::string missing_text(const SceneRun* run, std::string_view scene, const char* device)
{
    if (run == nullptr) return fmt::format("{} was not traced", scene);
    if (!run->likeness.is_compared()) return fmt::format("{} is {}", scene, run->likeness.reason);
    return fmt::format("no row of maria has a rate on a {} for {}", device, scene);
}

} // namespace

PaperCell quantity_beside(const Estimate& ours, std::optional<double> paper, const SceneRun& run)
{
    return Quantity{ours, is_for_rays(run) ? std::nullopt : paper, run.likeness.is_compared()};
}

std::vector<std::string> likeness_notes(const SceneRuns& runs)
{
    std::vector<std::string> notes;
    for (const SceneRun* run : runs)
        if (run->likeness.kind == LikenessKind::other_mesh || run->likeness.kind == LikenessKind::near_counts)
            notes.push_back(fmt::format("{}, {} build: {}", run->build.scene, run->build.build, run->likeness.reason));
    return notes;
}

const SceneRun* judged_run(const SceneRuns& runs, std::string_view scene)
{
    const SceneRun* found = nullptr;
    for (const SceneRun* run : runs_of_cdt(runs))
        if (run->build.scene == scene && run->scene != nullptr &&
            (found == nullptr || run->build.build == papers_build))
            found = run;
    return found;
}

Claim mean_rate_claim(const SceneRuns& runs, paper::Place place)
{
    const bool is_cpu = place == paper::Place::cpu;
    const char* const device = is_cpu ? "CPU" : "GPU";
    const double papers = paper::mean_mrays(place);
    Claim claim{fmt::format("maria-reaches-the-papers-rate-{}", is_cpu ? "cpu" : "gpu"),
                fmt::format("maria traces at least {} Mrays/s on a {}, on average over the paper's three scenes",
                            papers, device)};
    Estimate mean{0, 0.0, 0.0, false};
    std::string missing;
    bool noisy = false;
    const auto scenes = static_cast<double>(paper::scenes().size());
    for (const paper::SceneFigures& figures : paper::scenes()) {
        const SceneRun* const run = judged_run(runs, figures.scene);
        const auto rate = run != nullptr ? best_rate(*run, place) : std::nullopt;
        if (rate)
            append_item(claim.evidence, "; ",
                        fmt::format("{} {:.4g} Mrays/s, the paper's {}", figures.scene, rate->mrays.value,
                                    figures.mrays(place)));
        if (!rate || !run->likeness.is_compared()) {
            append_item(missing, "; ", missing_text(run, figures.scene, device));
            continue;
        }
        mean.value += rate->mrays.value / scenes;
        *mean.low += *rate->mrays.low / scenes;
        *mean.high += *rate->mrays.high / scenes;
        noisy = noisy || rate->noisy;
    }
    if (!claim.evidence.empty()) claim.evidence += ". ";
    if (!missing.empty()) {
        claim.evidence += fmt::format("Not all three scenes: {}{}", missing, missing.back() == '.' ? "" : ".");
        return claim;
    }
    claim.verdict = judge_above({Estimate{mean.value / papers, *mean.low / papers, *mean.high / papers, false}}, 1);
    claim.evidence += fmt::format("Their mean is {}, {:.3g} of the paper's on its {}.", estimate_text(mean),
                                  mean.value / papers, is_cpu ? paper::cpu_name : paper::gpu_name);
    withdraw_if_noisy(claim, noisy);
    return claim;
}

} // namespace tetrace
