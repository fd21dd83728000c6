#pragma once

#include "bench/measuring/budget.h"
#include "bench/options/options.h"
#include "bench/rows/row_run.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What became of a variant.
enum class VariantSight {
    right,
    wrong,        ///< other hits than those of the unchanged kernel
    not_compiled, ///< a compiler refused it, crashed or gave no answer
    not_run       ///< the driver failed while it ran
};
template <>
inline constexpr auto enum_names<VariantSight> = names_up_to<VariantSight::not_run>("right", "wrong", "not compiled",
                                                                                    "not run");

/// A variant that fails.
struct VariantFailure {
    std::uint32_t number = 0; ///< of the variant, from 1
    VariantSight sight = VariantSight::wrong;
    std::size_t changes = 0;                          ///< how many it has
    std::vector<std::string> reduced;                 ///< the fewest that were seen to fail alike; empty: not reduced
    bool is_unfinished = false;                       ///< the reduction ended early: fewer changes may do
    std::optional<std::uint32_t> same_as;             ///< an earlier variant, whose reduced changes it has too
    std::uint32_t tries = 0;                          ///< of the reduction
    std::uint64_t different = 0;                      ///< rays, of the view of first_different, with all its changes
    std::optional<DifferingRay> first_different = {}; ///< with the reduced changes
    std::string reason;                               ///< what the driver said; empty if only hits differ
    std::string command;                              ///< that writes the reduced kernel; empty if no command line can
};

/// The variants of a row.
struct VariantRow {
    RowRecord row;           ///< with the text as it is
    std::size_t changes = 0; ///< that its text can have
    std::size_t made = 0;    ///< changes of all variants that ran
    std::uint32_t ran = 0;
    std::vector<VariantFailure> failures;
    std::string reason;          ///< why none ran; empty if they should
    bool fails_as_it_is = false; ///< the text as it is is wrong, or its driver fails; then none runs

    [[nodiscard]] std::size_t count(VariantSight sight) const;
};

/// Runs Options::variants variants of each row, one after the other in turn for all rows, and reduces those that fail.
/// rows: verified with their text as it is, which is right; those without right answers keep their reason. Ends early
/// when the budget is spent or the user interrupts.
[[nodiscard]] std::vector<VariantRow> run_variants(std::vector<RowRun>& rows, const Options& options,
                                                   const Budget& budget);

} // namespace tetrace
