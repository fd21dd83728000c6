#pragma once

#include "bench/output/report.h"
#include "bench/results/result_file.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

[[nodiscard]] bool is_check(const ResultFile& file);

/// How an item of two checks compares. changed: another result, and neither fails, or both do. different: of other
/// work.
enum class CheckChange { same, changed, became_right, became_wrong, added, missing, different };
template <>
inline constexpr auto enum_names<CheckChange> = names_up_to<CheckChange::different>("SAME", "CHANGED", "BECAME RIGHT",
                                                                                    "BECAME WRONG", "NEW", "MISSING",
                                                                                    "DIFFERENT");

/// A row, an item of a device's self-test, or a reduced kernel on a device, as a check found it.
struct CheckedItem {
    std::string name;        ///< of the row, or "self_test/division_ulps on vulkan", or "defect/NAME on vulkan"
    std::string finding;     ///< what is compared: "wrong"
    std::string shown;       ///< the same with numbers: "wrong: 12 rays"
    bool fails = false;      ///< whether it makes a check fail where nothing else is expected
    bool has_result = true;  ///< whether it ran
    std::string reason = {}; ///< of an item that fails or did not run
};

/// An item of one or both checks.
struct ComparedItem {
    std::optional<CheckedItem> before, after; ///< one of them is there
    CheckChange change = CheckChange::same;
    std::string difference = {}; ///< of different ones: what differs

    [[nodiscard]] const std::string& name() const { return (before ? before : after)->name; }
    /// Why it fails or has no result in B; else in A; else empty.
    [[nodiscard]] std::string note() const;
};

/// Two checks by their verdicts. Refers to the results.
struct CheckComparison {
    const ResultFile* before = nullptr;
    const ResultFile* after = nullptr;
    std::vector<ComparedItem> items; ///< in the order of before, then those that only after has

    [[nodiscard]] std::size_t count(CheckChange change) const;
    /// Items that became wrong, new ones that fail, and missing ones unless those are allowed.
    [[nodiscard]] std::vector<const ComparedItem*> regressions(bool allow_missing) const;
};

/// Compares items of equal names, of those whose name the regular expression matches (empty: all); self-tests of
/// devices that both have. Rows that did different work (different_rays()) are not compared. Precondition: both are
/// checks. Throws Error{invalid_input} if they share no item, if all shared rows did different work, or if a row is not
/// one of this tetrace's; Error{usage} if the expression matches none.
[[nodiscard]] CheckComparison compare_checks(const ResultFile& before, const ResultFile& after,
                                             const std::string& filter);

/// What changed, for people; all items flat; and as results record it (`check_comparison` of results/README.md).
[[nodiscard]] Report check_comparison_report(const CheckComparison& comparison, const Options& options);

} // namespace tetrace
