#pragma once

#include "bench/variants/variant_trials.h"

namespace tetrace {

/// Runs variants of each row, as run_trials(). rows: verified with their text as it is, which is right; those without
/// right answers keep their reason.
[[nodiscard]] std::vector<VariantRow> run_variants(std::vector<RowRun>& rows, const Options& options,
                                                   const Budget& budget);

} // namespace tetrace
