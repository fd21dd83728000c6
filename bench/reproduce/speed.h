#pragma once

#include "bench/measuring/row_recorder.h"
#include "bench/reproduce/claims.h"
#include "bench/reproduce/paper.h"

#include <functional>
#include <vector>

namespace tetrace {

/// The CDT's methods that are older than maria, the paper's own, in the order of all_kernels().
[[nodiscard]] const std::vector<Method>& older_methods();

/// Device seconds of each view or batch: the medians of its samples. Empty for a row without a rate.
[[nodiscard]] std::vector<double> view_seconds(const RecordedRows& run, std::size_t row);

/// Mean number of tets that a ray leaves, view by view.
[[nodiscard]] std::vector<double> view_steps(const RecordedRows& run, std::size_t row);

/// The paper's device that the row's is compared with: a CPU with its CPU, a GPU with its GPU, and nothing that
/// emulates one.
[[nodiscard]] std::optional<paper::Place> paper_place(const RowRecord& row);

/// "bunny maria tet80 openmp": a row in a figure.
[[nodiscard]] std::string series_name(const RowRecord& row);

/// The runs that a claim is about; rows of different runs are never compared.
using RecordedRuns = std::vector<const RecordedRows*>;
/// For tables of rates: the row's status, "noisy" where that is all that speaks against it, with its reason.
[[nodiscard]] std::string status_with_reason(const RowRecord& row);

/// Whether the claim is about this row of maria.
using IsMeant = std::function<bool(const RowRecord&)>;

// Claims of speed are not testable where one of their rows is noisy.

// claim: its id and text.

[[nodiscard]] bool is_noisy(const RowRecord& row);
/// The interval over views does not cover the load of other users on the machine: noisy rows decide nothing.
void withdraw_if_noisy(Claim& claim, bool noisy);

/// "maria is the fastest of the five", for each of maria's rows that the claim is about: the time of each older method
/// over maria's, in the same views and layout, on the same device. Not testable unless all of them have a rate.
[[nodiscard]] Claim fastest_claim(Claim claim, const RecordedRuns& runs, const IsMeant& is_meant);

/// "This is the fastest of the older methods", for each of its rows that the claim is about: the time of each other
/// older method over its own. As fastest_claim().
[[nodiscard]] Claim fastest_older_claim(Claim claim, const RecordedRuns& runs, Method method, const IsMeant& is_meant);

/// "The method takes this share more time than maria": its time over maria's is within slower_tolerance of 1 + slower,
/// on each row of maria that the claim is about.
[[nodiscard]] Claim slower_claim(Claim claim, const RecordedRuns& runs, Method method, double slower,
                                 const IsMeant& is_meant);
inline constexpr double slower_tolerance = 0.1;

/// "Plucker overtakes stp", on every GPU and scene: stp's time over plucker's.
[[nodiscard]] Claim overtaking_claim(Claim claim, const RecordedRuns& runs);

/// fastest_claim() for the walk through the scenes, on a CPU; and overtaking_claim().
[[nodiscard]] std::vector<Claim> speed_claims(const RecordedRuns& runs);

/// "Time is proportional to the tets traversed", for maria's rows on one kind of device: over each row's views, the
/// points lie on a line (correlation), and the line passes near the origin (its value at 0 tets, as a part of the mean
/// time).
[[nodiscard]] Claim proportional_claim(const RecordedRuns& runs, DeviceKind kind);
/// "Time is linear in the tets traversed": the points lie on a line.
[[nodiscard]] Claim linear_claim(const RecordedRuns& runs, DeviceKind kind);
/// "Not strictly proportional, because of cache misses when more are traversed": the time of a tet grows with their
/// number. The correlation of the two is above 0.
[[nodiscard]] Claim slower_tets_claim(const RecordedRuns& runs, DeviceKind kind);
inline constexpr double proportional_above = 0.9, proportional_intercept = 0.1;

} // namespace tetrace
