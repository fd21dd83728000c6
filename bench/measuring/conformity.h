#pragma once

#include "bench/rows/row_record.h"

#include <string>

namespace tetrace {

/// How a row's answers compare with openmp's; a cell of `tetrace check`.
enum class Conformity {
    reference,   ///< openmp's own, in exact mode
    bit_exact,   ///< every bit of every hit is openmp's
    within_ulps, ///< the same except for t, u and v, which are within what the device's self-test allows
    uncompared,  ///< nothing to compare with: math mode fast, and Embree
    not_exact,   ///< openmp's answers here, but the self-test shows that the device computes differently
    wrong,
    unsupported,
    skipped,
    error
};
/// The kind only, as tests/expected/ records it.
template <>
inline constexpr auto enum_names<Conformity> = names_up_to<Conformity::error>("reference", "bit-exact", "within ulps",
                                                                              "not compared", "not exact", "wrong",
                                                                              "unsupported", "skipped", "error");

[[nodiscard]] Conformity conformity_of(const RowRecord& row);

/// What the row shows; of one that differs between repetitions the worst. flawed_passes: as of fails().
[[nodiscard]] Finding finding_of(const RowRecord& row, bool flawed_passes);

/// Of a row that differs between repetitions how often it showed its worst: "wrong in 2 of 10"; else empty.
[[nodiscard]] std::string rate_text(const RowRecord& row);

/// The rows of several repetitions of a check as one: of each row the first repetition that shows the worst, with what
/// each showed. Repetitions without a result count only if all are so. repetitions: at least one, all with the same
/// rows.
[[nodiscard]] std::vector<RowRecord> combined_rows(const std::vector<std::vector<RowRecord>>& repetitions,
                                                   bool flawed_passes);

/// The cell with numbers and self-test findings: "within 2 ulp", "wrong: 12 rays", "not exact: contracts"; of a row
/// that differs between repetitions with its rate: "wrong: 12 rays, in 2 of 10".
/// Rows without anything to compare with show the oracle's status.
[[nodiscard]] std::string conformity_text(const RowRecord& row);

/// Whether the row makes a check fail; a row without an answer does not by itself (see exit_code and --require). Wrong
/// and lost rays that openmp has bit for bit are the method's fault and not the device's. flawed_passes: as of fails().
[[nodiscard]] bool fails_check(const RowRecord& row, bool flawed_passes);

} // namespace tetrace
