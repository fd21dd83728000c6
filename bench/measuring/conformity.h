#pragma once

#include "bench/rows/row_run.h"

#include <string>
#include <string_view>

namespace tetrace {

/// How a row's answers stand to openmp's: what a cell of `tetrace check` says.
enum class Conformity {
    reference,   ///< openmp's own, in exact mode
    bit_exact,   ///< every bit of every hit is openmp's
    within_ulps, ///< but for t, u and v, within what the device's self-test allows
    uncompared,  ///< there is nothing to compare with: math mode fast, and Embree
    not_exact,   ///< openmp's answers here, but the self-test shows that the device computes otherwise
    wrong,
    unsupported,
    skipped,
    error
};

[[nodiscard]] Conformity conformity_of(const RowRun& row);

/// The kind alone, as tests/expected/ records it: "bit-exact", "within ulps".
[[nodiscard]] std::string_view name_of(Conformity conformity);

/// The cell, numbers and what the self-test found included: "within 2 ulp", "wrong: 12 rays", "not exact: contracts".
/// Rows that have nothing to be compared with show the oracle's status.
[[nodiscard]] std::string conformity_text(const RowRun& row);

} // namespace tetrace
