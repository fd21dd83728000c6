#pragma once

#include "bench/statistics/statistics.h"
#include "core/base/enum_names.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// The verdict of the measured intervals on a claim of the paper; a claim starts as not testable.
enum class ClaimVerdict { not_testable, holds, does_not_hold };
template <>
inline constexpr auto enum_names<ClaimVerdict> = names_up_to<ClaimVerdict::does_not_hold>("not testable here", "holds",
                                                                                          "does not hold");

/// A sentence of the paper, and its verdict here.
struct Claim {
    std::string id, text;
    ClaimVerdict verdict{};    ///< until a rule decides
    std::string evidence = {}; ///< the numbers that decided, or what is missing for a decision
};

// The rules below turn intervals into verdicts; the caller words the claims. A rule never decides on missing data:
// if an interval crosses the boundary, or is without bounds, the claim is not testable.

/// "There are none." A single one refutes it, and only a count of all proves it: a sample without any may have missed
/// some.
[[nodiscard]] ClaimVerdict judge_none(const Estimate& count);
/// "There are some": the opposite.
[[nodiscard]] ClaimVerdict judge_some(const Estimate& count);
/// "The first is less than each of the others", with separate estimates: the intervals must not meet; refuted by one of
/// the others that is nowhere above the first. Not testable without others.
[[nodiscard]] ClaimVerdict judge_less(const Estimate& first, const std::vector<Estimate>& others);
/// "Every ratio is above the boundary": all intervals above it; refuted by one that is wholly below.
[[nodiscard]] ClaimVerdict judge_above(const std::vector<Estimate>& ratios, double boundary);
/// "Every number is 0, give or take the reach": all intervals within the reach; refuted by one that is wholly outside.
[[nodiscard]] ClaimVerdict judge_within(const std::vector<Estimate>& numbers, double reach);
/// "Both hold": refuted where one of them is.
[[nodiscard]] ClaimVerdict judge_both(ClaimVerdict a, ClaimVerdict b);
/// "The number is the paper's, within the tolerance": for numbers without a spread. tolerance: relative, >= 0.
[[nodiscard]] ClaimVerdict judge_equal(double ours, double papers, double tolerance);

[[nodiscard]] nlohmann::json claim_json(const Claim& claim);

/// "1.25 [1.1, 1.4]"; only the value if there are no bounds.
[[nodiscard]] std::string estimate_text(const Estimate& estimate);

} // namespace tetrace
