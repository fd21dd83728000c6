#pragma once

#include "bench/rows/row_record.h"
#include "bench/statistics/statistics.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Figures of a timed row; rows without a rate have none.
struct Figures {
    Statistics kernel_s;                ///< device seconds for all selected views, traced together
    double mrays_per_s = 0;             ///< throughput
    std::optional<double> mhits_per_s;  ///< of the rays that hit
    std::optional<double> msteps_per_s; ///< structure cdt only
    std::optional<double> gb_per_s;     ///< estimated: steps times bytes_per_step()
    std::optional<double> wall_s;       ///< from launch to the end of wait by the host's clock, all views; median
    std::optional<double> overhead_s;   ///< launching and waiting: median of the samples' wall minus device seconds
    std::optional<double> latency_s;    ///< device seconds of a view that is traced alone, mean of the views; median
    std::optional<double> latency_mrays_per_s;
    std::optional<double> fixed_s;    ///< of a launch; empty if it is not above the noise, see launch_line()
    std::optional<double> s_per_mray; ///< of a million rays, without fixed_s if that is known
    bool noisy = false;               ///< the samples' spread, or what disturbed them, speaks against the rate
};

/// Empty unless the row is ok or flawed and has samples.
[[nodiscard]] std::optional<Figures> figures_of(const RowRecord& row);

/// What speaks against a row's rate: "flawed", "noisy", or "flawed, noisy"; empty if nothing does.
[[nodiscard]] std::string remarks_on(const RowRecord& row);

/// Bytes that a step of the walk loads from its tet's record, on average (docs/spec/devices.md, W7): three or four
/// vertices and a face. An estimate of the memory traffic: memory transfers whole lines, and caches hold some of them.
/// 0 for Embree's layout, which does not have steps.
[[nodiscard]] double bytes_per_step(const KernelId& kernel);

/// Steps per ray; empty without rays, or if the structure does not have steps.
struct MeanSteps {
    std::optional<double> all, hit, miss;
};
[[nodiscard]] MeanSteps mean_steps(const RayTotals& totals);

/// Of a row's rays, from 0 to 1; empty without rays, or if the number is not known.
struct RayShares {
    std::optional<double> enter; ///< the domain's box
    std::optional<double> hit;
};
[[nodiscard]] RayShares ray_shares(const Traced& traced);

/// The row's Mrays/s over those of Embree's single rays on the same scene, through the faster of its trees; empty where
/// either has none, and for rows that do not run on the host with as many threads, as Embree does.
[[nodiscard]] std::optional<double> ratio_to_single(const RowRecord& row, const std::vector<RowRecord>& rows);

} // namespace tetrace
