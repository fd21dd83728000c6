#pragma once

#include "bench/output/bench_report.h"
#include "bench/results/result_file.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tetrace {

/// What `tetrace check` found; refers to the rows.
struct CheckFindings {
    const std::vector<RowRecord>* rows = nullptr;
    std::vector<nlohmann::json> scenes; ///< as results record them
    std::vector<std::string> missing;   ///< devices, a sentence each
    bool interrupted = false;
    std::set<std::string> known = {}; ///< names of rows that fail as expected: their rays are not printed
};

/// What a row's fields are read from, its conformity included.
[[nodiscard]] RowFacts check_facts(const RowRecord& row);

/// Every row, flat.
[[nodiscard]] Table check_table(const std::vector<RowRecord>& rows, const RunOrigin& origin);

/// What `check` prints, and `show` prints again.
[[nodiscard]] Sheet check_sheet(const CheckFindings& found);

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
