#include "bench/measuring/figures.h"

#include "bench/rows/physical_device.h"
#include "bench/statistics/launch_line.h"
#include "core/pack/kernel_id.h"

#include <algorithm>

namespace tetrace {

namespace {

std::optional<double> quotient(std::uint64_t steps, std::uint64_t rays)
{
    if (steps == 0 || rays == 0) return std::nullopt;
    return static_cast<double>(steps) / static_cast<double>(rays);
}

/// Empty if the wall clock was not read for every sample.
void add_wall(Figures& figures, const RowRecord& row)
{
    if (row.wall_samples_s.size() != row.samples_s.size()) return;
    std::vector<double> overheads;
    for (std::size_t i = 0; i < row.samples_s.size(); ++i)
        overheads.push_back(row.wall_samples_s[i] - row.samples_s[i]);
    figures.wall_s = quantile(row.wall_samples_s, 0.5);
    figures.overhead_s = quantile(std::move(overheads), 0.5);
}

/// Empty unless views had a launch each. The line through both needs launches that follow each other.
void add_latency(Figures& figures, const RowRecord& row)
{
    const auto& [joined, single] = row.launches;
    const std::vector<double>& samples_s = has_latency(row) ? row.samples_s : row.latency_samples_s;
    if (samples_s.empty() || single == 0) return;
    const double pass_s = quantile(samples_s, 0.5), mrays = 1e-6 * static_cast<double>(traced(row)->totals.rays);
    figures.latency_s = pass_s / single;
    figures.latency_mrays_per_s = mrays / pass_s;
    if (row.key.in_flight > 1) return;
    const LaunchLine line =
        launch_line({static_cast<double>(joined), row.samples_s}, {static_cast<double>(single), samples_s}, mrays);
    figures.fixed_s = line.fixed_s;
    figures.s_per_mray = line.s_per_unit;
}

/// A step of a task that crosses tets loads all four vertices, for the method and for the place on the exit face, and
/// what is across that face. The layouts with records are read as rows of 16 bytes; a row of tet64 has both.
double bytes_to_cross(Layout layout)
{
    if (layout == Layout::tet64) return 4 * 16;
    if (layout == Layout::half32) return 4 * 16 + 16;
    return 4 * traits_of(layout).vertex_bytes + traits_of(layout).step_bytes;
}

constexpr double bytes_of_addition = 8; // a word of a sum is read and written

} // namespace

double bytes_per_step(const KernelId& kernel)
{
    const LayoutTraits& layout = traits_of(kernel.layout);
    const TaskTraits& task = traits_of(kernel.task);
    if (task.crosses) return bytes_to_cross(kernel.layout) + (task.tallies ? bytes_of_addition : 0);
    return traits_of(kernel.method).vertices * layout.vertex_bytes + layout.step_bytes;
}

MeanSteps mean_steps(const RayTotals& totals)
{
    return {quotient(totals.steps(), totals.rays), quotient(totals.hit_steps, totals.hits),
            quotient(totals.miss_steps, totals.misses)};
}

RayShares ray_shares(const Traced& traced)
{
    const auto share_of = [&](std::uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(traced.totals.rays);
    };
    RayShares shares;
    if (traced.totals.rays == 0) return shares;
    if (traced.entering) shares.enter = share_of(*traced.entering);
    shares.hit = share_of(traced.totals.hits);
    return shares;
}

std::optional<Figures> figures_of(const RowRecord& row)
{
    if (!has_answers(row) || row.samples_s.empty()) return std::nullopt;
    const RayTotals& totals = traced(row)->totals;
    Figures figures;
    figures.kernel_s = statistics_of(row.samples_s);
    figures.noisy = figures.kernel_s.noisy() || !row.disturbance.empty();
    const double seconds = figures.kernel_s.median;
    add_wall(figures, row);
    add_latency(figures, row);
    figures.mrays_per_s = 1e-6 * static_cast<double>(totals.rays) / seconds;
    if (totals.hits > 0) figures.mhits_per_s = 1e-6 * static_cast<double>(totals.hits) / seconds;
    if (totals.steps() == 0) return figures;
    figures.msteps_per_s = 1e-6 * static_cast<double>(totals.steps()) / seconds;
    if (const double bytes = bytes_per_step(row.key.kernel); bytes > 0)
        figures.gb_per_s = 1e-3 * *figures.msteps_per_s * bytes;
    return figures;
}

std::string remarks_on(const RowRecord& row)
{
    const auto figures = figures_of(row);
    const std::string flawed = status_of(row) == Status::flawed ? "flawed" : "";
    if (!figures || !figures->noisy) return flawed;
    return flawed.empty() ? "noisy" : flawed + ", noisy";
}

std::optional<double> ratio_to_single(const RowRecord& row, const std::vector<RowRecord>& rows)
{
    if (!runs_on_host(row.device)) return std::nullopt;
    const auto figures = figures_of(row);
    double fastest = 0;
    for (const RowRecord& other : rows)
        if (is_embree(other.key.kernel.layout) && other.key.kernel.method == Method::single &&
            same_rays(other.key, row.key) && same_load(other.key, row.key))
            if (const auto single = figures_of(other)) fastest = std::max(fastest, single->mrays_per_s);
    if (!figures || fastest == 0) return std::nullopt;
    return figures->mrays_per_s / fastest;
}

} // namespace tetrace
