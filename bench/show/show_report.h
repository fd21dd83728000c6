#pragma once

#include "bench/output/bench_report.h"
#include "bench/results/result_file.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What `tetrace check` found; refers to the rows.
struct CheckFindings {
    const std::vector<RowRecord>* rows = nullptr;
    std::vector<nlohmann::json> scenes; ///< as results record them
    std::vector<std::string> missing;   ///< devices, a sentence each
    bool interrupted = false;
};

/// What a row's fields are read from, its conformity included.
[[nodiscard]] RowFacts check_facts(const RowRecord& row);

/// Every row, flat.
[[nodiscard]] Table check_table(const std::vector<RowRecord>& rows, const RunOrigin& origin);

/// What `check` prints, and `show` prints again.
[[nodiscard]] Sheet check_sheet(const CheckFindings& found);

/// The verdict of a check, and the line that it ends with.
struct CheckVerdict {
    bool conforms = true;
    std::string text; ///< "13 rows on 2 devices.", or "6 of 13 rows, all on opencl."

    [[nodiscard]] Sheet line() const;
};
/// Empty if no row was judged. flawed_passes: as of fails_check(). required: backends of which each row must have an
/// answer.
[[nodiscard]] std::optional<CheckVerdict> verdict_of(const std::vector<RowRecord>& rows, bool flawed_passes,
                                                     const std::vector<std::string>& required);
/// In a result, under "verdict".
void set_verdict(nlohmann::json& section, const std::optional<CheckVerdict>& verdict);

/// A run again, for people and flat.
struct RunAgain {
    Sheet sheet;
    Table table;
};

/// What a run of `bench` or `check` printed, made from its result by what made it then. A line at the end names what
/// the result does not have. brief: of `bench`, brief_sheet(). Throws Error{invalid_input} for results of other verbs,
/// and as read_rows() does.
[[nodiscard]] RunAgain run_again(const ResultFile& file, bool brief = false);

} // namespace tetrace
