#pragma once

#include "bench/output/row_fields.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
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
[[nodiscard]] Table check_table(const std::vector<RowRecord>& rows);

/// What `check` prints, and `show` prints again.
[[nodiscard]] Sheet check_sheet(const CheckFindings& found);

} // namespace tetrace
