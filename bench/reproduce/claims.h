#pragma once

#include "bench/statistics/interval.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// What the measured intervals say of a claim of the paper; not testable is what a claim begins as.
enum class ClaimVerdict { not_testable, holds, does_not_hold };
[[nodiscard]] std::string_view name_of(ClaimVerdict verdict); ///< "holds", "does not hold", "not testable here"

/// A sentence of the paper, and what became of it here.
struct Claim {
    std::string id, text;
    ClaimVerdict verdict{}; ///< until something decides
    std::string evidence;   ///< the numbers that decided, or what is missing to decide
};

// The rules below turn intervals into verdicts; the words of a claim are its caller's. A rule never decides on what it
// does not have: where an interval reaches over the boundary, or has no bound, the claim is not testable.

/// "There are none." One that was seen refutes it; only a count of all proves it: a sample without any leaves room for
/// those that were not looked at.
[[nodiscard]] ClaimVerdict judge_none(const Estimate& count);
/// "There are some": the opposite.
[[nodiscard]] ClaimVerdict judge_some(const Estimate& count);
/// "The first is less than each of the others", all estimated apart: their intervals must not meet; refuted by one
/// that is nowhere above it. Without others, nothing can be said.
[[nodiscard]] ClaimVerdict judge_less(const Estimate& first, const std::vector<Estimate>& others);
/// "Every ratio is above the boundary": all intervals above it; refuted by one that is wholly below.
[[nodiscard]] ClaimVerdict judge_above(const std::vector<Estimate>& ratios, double boundary);
/// "Every number is 0, give or take the reach": all intervals within; refuted by one that is wholly outside.
[[nodiscard]] ClaimVerdict judge_within(const std::vector<Estimate>& numbers, double reach);
/// "Both hold": refuted where one is.
[[nodiscard]] ClaimVerdict judge_both(ClaimVerdict a, ClaimVerdict b);
/// "The number is the paper's, within the tolerance": for numbers without a spread. tolerance: relative, >= 0.
[[nodiscard]] ClaimVerdict judge_equal(double ours, double papers, double tolerance);

[[nodiscard]] nlohmann::json claim_json(const Claim& claim);

/// "1.25 [1.1, 1.4]"; the value alone without bounds.
[[nodiscard]] std::string estimate_text(const Estimate& estimate);

} // namespace tetrace
