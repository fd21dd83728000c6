#pragma once

#include "bench/rows/contest.h"
#include "bench/rows/row_record.h"
#include "bench/statistics/rank_interval.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// The speed of a row compared with its reference.
struct Comparison {
    const RowRecord* reference = nullptr;
    double ratio = 0; ///< row's rate over reference's, from medians of device seconds; above 1 the row is faster
    std::optional<FactorInterval> interval; ///< of the ratio; empty if either has fewer than min_samples in a run
    std::size_t runs = 1; ///< that the interval spans, see ratio_over_runs(); of 1 it is of the samples, 95 %
};

/// The row's rate over reference's. Precondition: both have samples.
[[nodiscard]] Comparison compare_rates(const RowRecord& reference, const RowRecord& row);

/// "[0.95, 1.03]"; empty without an interval.
[[nodiscard]] std::string interval_text(const Comparison& comparison);

/// The reference of each row, row by row: the same kernel on the same scene and the same hardware (see
/// physical_devices()) and as many threads, with schedule tiles. The reference runs under reference_name(), and on a
/// GPU that lacks it under the first API that has the row. A GPU's rows and the host's, which include emulations, are
/// therefore never compared. Empty for references themselves, Embree's rows, and rows without a rate.
[[nodiscard]] std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRecord>& rows);

/// What Contest asks of a row.
[[nodiscard]] std::optional<double> mrays_of(const RowRecord& row);
[[nodiscard]] inline const KernelId& kernel_of(const RowRecord& row)
{
    return row.key.kernel;
}

/// The contests of rows, whatever became of them. Their devices are the host (of openmp and Embree), a GPU under all
/// its APIs, or one emulated device of one backend. Rows whose device is not known are in none, except for openmp's and
/// Embree's: these run on the host.
[[nodiscard]] std::vector<Contest<RowRecord>> contests_of(const std::vector<const RowRecord*>& rows);
/// Of all rows; they keep their addresses.
[[nodiscard]] std::vector<Contest<RowRecord>> contests_of(const std::vector<RowRecord>& rows);

/// Each row compared with the fastest BVH of its contest, row by row. That BVH's own ratio is 1, without an interval.
/// Empty for rows without a rate or a BVH to compare with.
[[nodiscard]] std::vector<std::optional<Comparison>> compare_with_best_bvh(const std::vector<RowRecord>& rows);

/// When building a row's tets has paid against the fastest BVH of its contest, both builds counted.
struct PaidBuild {
    enum class When { at_once, later, never, unclear };
    When when = When::never;
    double rays = 0;      ///< of later: after this many
    double tracing_s = 0; ///< of later: seconds that the row takes for them
};
template <>
inline constexpr auto enum_names<PaidBuild::When> = names_up_to<PaidBuild::When::unclear>("at once", "later", "never",
                                                                                          "unclear");

/// best_bvh: the row's comparison with it. unclear: the interval of the ratio contains 1. Empty for rows of BVHs, and
/// if a build time is not known.
[[nodiscard]] std::optional<PaidBuild> paid_build(const RowRecord& row, const std::optional<Comparison>& best_bvh);

} // namespace tetrace
