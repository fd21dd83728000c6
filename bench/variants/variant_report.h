#pragma once

#include "bench/output/report.h"
#include "bench/results/result_value.h"
#include "bench/variants/variant_trials.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// Variants for people, and every row flat.
struct ShownVariants {
    Sheet sheet;
    Table table;
};

/// What `check --variants` and `inspect --variants` print, and `show` prints again. section: of its result. Throws
/// Error{invalid_input} naming the key that is missing or of another kind.
[[nodiscard]] ShownVariants shown_variants(const ResultValue& section);

/// missing: sentences on backends without a device. scenes: as results record them. `inspect` has neither.
[[nodiscard]] Report variant_report(const std::vector<VariantRow>& rows, const std::vector<nlohmann::json>& scenes,
                                    const std::vector<std::string>& missing, const Options& options);

/// One suite, a test case for each row, which fails if a variant does. problem: as in junit_xml().
[[nodiscard]] std::string variant_junit(const std::vector<VariantRow>& rows, const std::string& problem = {});

/// 1 if a variant failed, or a kernel as it is; 3 if none ran; else 0.
[[nodiscard]] int exit_code(const std::vector<VariantRow>& rows);

} // namespace tetrace
