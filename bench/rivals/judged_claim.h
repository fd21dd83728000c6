#pragma once

#include "bench/reproduce/claims.h"
#include "bench/rivals/rival_claims.h"
#include "bench/rows/row_record.h"
#include "bench/statistics/statistics.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What claims ask of a scene.
struct ContestScene {
    std::string name;
    TetsKind tets = TetsKind::rays;
    bool has_own_views = false; ///< those that the catalogue gives it
};

/// Those of a result's `scenes`.
[[nodiscard]] std::vector<ContestScene> contest_scenes(const std::vector<nlohmann::json>& scenes);

/// A contest (contests_of() in bench/measuring/comparison.h), with its rays and what is known of its scene.
struct RivalContest : Contest<RowRecord> {
    RowKey key; ///< of its first row
    DeviceKind place = DeviceKind::cpu;
    std::optional<ContestScene> scene; ///< empty if it could not be loaded
};

/// All contests, in the order of their first rows, without our kernels in fast mode. rows: keep their addresses.
[[nodiscard]] std::vector<RivalContest> rival_contests(const std::vector<RowRecord>& rows,
                                                       const std::vector<ContestScene>& scenes);

/// The row's rate over the other's, with the interval of compare_rates(). Precondition: both have rates.
[[nodiscard]] Estimate rate_ratio(const RowRecord& row, const RowRecord& over);

/// A claim's measure in one contest.
struct ClaimNumber {
    const RivalContest* contest = nullptr;
    const RowRecord *walk = nullptr, *rival = nullptr; ///< both with rates
    Estimate value;
};

/// A claim with its verdict, and what decided it.
struct JudgedClaim {
    const RivalClaim* claim = nullptr;
    ClaimVerdict verdict = ClaimVerdict::not_testable;
    std::vector<ClaimNumber> numbers;   ///< one for each contest that has both rows
    std::vector<std::string> obstacles; ///< reasons why it cannot be said to hold, a phrase each
    std::vector<std::string> missing;   ///< scenes of the claim without such rows
    bool may_refute = true;             ///< no row is missing that could speak for the claim
};

/// What options left out of a run: one of those rows could be the fastest.
struct LeftOut {
    bool kernels = false;              ///< of any device
    bool apis = false;                 ///< APIs of a GPU that has rows of another API
    std::vector<RowKey> filtered = {}; ///< rows that --filter left out
};

/// Judges a claim by the contests that it is about. It holds only if every number's interval is on the right side of
/// the boundary and there is no obstacle: a rival without a rate could be the fastest, and a noisy row decides nothing.
/// One number whose interval is on the wrong side refutes it, unless one of its two rows is noisy, or a row is missing
/// that could put it on the right side. Scenes that were not traced are named, and the others decide.
[[nodiscard]] JudgedClaim judge(const RivalClaim& claim, const std::vector<RivalContest>& contests,
                                const LeftOut& left_out);

/// "0.91 [0.90, 0.92]"; seconds end in their unit, and infinite ones are "never".
[[nodiscard]] std::string number_text(const RivalClaim& claim, const Estimate& value);

/// The rule that decides the claim, as a clause.
[[nodiscard]] std::string rule_of(const RivalClaim& claim);

/// The claim as results record it: its text says where it was made, and its evidence has the old figure,
/// the new ones, the rule, and the rows.
[[nodiscard]] Claim to_claim(const JudgedClaim& judged);

/// Seconds of tracing with a structure that takes this much longer to build than another, and has `ratio` times its
/// rate, after which it has made up for the build; infinite: never.
[[nodiscard]] double seconds_until_paid(double more_s, double ratio);

/// The same of a walk and another row, builds and packing counted, with an interval from that of the ratio of their
/// rates. Empty if a build time is unknown. Precondition: both rows have rates.
[[nodiscard]] std::optional<Estimate> tracing_until_paid(const RowRecord& walk, const RowRecord& other);

} // namespace tetrace
