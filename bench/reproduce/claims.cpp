#include "bench/reproduce/claims.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

ClaimVerdict judge_none(const Estimate& count)
{
    if (count.value > 0) return ClaimVerdict::does_not_hold;
    return count.exact ? ClaimVerdict::holds : ClaimVerdict::not_testable;
}

ClaimVerdict judge_some(const Estimate& count)
{
    switch (judge_none(count)) {
    case ClaimVerdict::holds: return ClaimVerdict::does_not_hold;
    case ClaimVerdict::does_not_hold: return ClaimVerdict::holds;
    case ClaimVerdict::not_testable: break;
    }
    return ClaimVerdict::not_testable;
}

ClaimVerdict judge_less(const Estimate& first, const std::vector<Estimate>& others)
{
    const auto is_below = [](const Estimate& a, const Estimate& b) { return a.highest() < b.lowest(); };
    const auto refutes = [&](const Estimate& other) { return other.highest() <= first.lowest(); };
    if (std::ranges::any_of(others, refutes)) return ClaimVerdict::does_not_hold;
    const bool all = std::ranges::all_of(others, [&](const Estimate& e) { return is_below(first, e); });
    return all && !others.empty() ? ClaimVerdict::holds : ClaimVerdict::not_testable;
}

ClaimVerdict judge_above(const std::vector<Estimate>& ratios, double boundary)
{
    if (std::ranges::any_of(ratios, [&](const Estimate& r) { return r.highest() < boundary; }))
        return ClaimVerdict::does_not_hold;
    const bool all = std::ranges::all_of(ratios, [&](const Estimate& r) { return r.lowest() > boundary; });
    return all && !ratios.empty() ? ClaimVerdict::holds : ClaimVerdict::not_testable;
}

ClaimVerdict judge_within(const std::vector<Estimate>& numbers, double reach)
{
    const auto is_inside = [&](const Estimate& e) { return e.lowest() >= -reach && e.highest() <= reach; };
    const auto is_outside = [&](const Estimate& e) { return e.lowest() > reach || e.highest() < -reach; };
    if (std::ranges::any_of(numbers, is_outside)) return ClaimVerdict::does_not_hold;
    const bool all = std::ranges::all_of(numbers, is_inside);
    return all && !numbers.empty() ? ClaimVerdict::holds : ClaimVerdict::not_testable;
}

ClaimVerdict judge_both(ClaimVerdict a, ClaimVerdict b)
{
    if (a == ClaimVerdict::does_not_hold || b == ClaimVerdict::does_not_hold) return ClaimVerdict::does_not_hold;
    return a == b ? a : ClaimVerdict::not_testable;
}

ClaimVerdict judge_equal(double ours, double papers, double tolerance)
{
    return std::abs(ours - papers) <= tolerance * papers ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
}

nlohmann::json claim_json(const Claim& claim)
{
    return {{"id", claim.id}, {"text", claim.text}, {"verdict", name_of(claim.verdict)}, {"evidence", claim.evidence}};
}

std::string estimate_text(const Estimate& estimate)
{
    const std::string value = fmt::format("{:.4g}", estimate.value);
    if (!estimate.low || !estimate.high) return value;
    return fmt::format("{} [{:.4g}, {:.4g}]", value, *estimate.low, *estimate.high);
}

} // namespace tetrace
