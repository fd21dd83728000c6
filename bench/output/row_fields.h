#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/terminal/table.h"

#include <functional>
#include <nlohmann/json.hpp>

namespace tetrace {

/// The sources of a row's fields. Refers to the row.
struct RowFacts {
    explicit RowFacts(const RowRun& run);

    const RowRun* row;
    SetupTimes setup; ///< all 0 where the row has no session
    std::optional<Figures> figures;
    // Set only by `bench`, which has all rows and devices.
    std::optional<Comparison> comparison;
    std::optional<double> ratio_to_single, share_of_copy;
    // Set only by `check`.
    std::optional<std::string> conformity;
};

/// Reads a field. It is built from a function of one part of a row, or from a member of that part: RowFacts, RowKey,
/// RowRun, Traced, Visits, Figures or Comparison. The field has no value (null) where the row lacks the part, and where
/// an optional result is empty.
class FieldValue {
public:
    template <class Read>
    FieldValue(Read read) : read_([read](const RowFacts& facts) { return read_from(read, facts); })
    {
    }
    [[nodiscard]] nlohmann::json operator()(const RowFacts& facts) const { return read_(facts); }

private:
    template <class T>
    static nlohmann::json json_of(const std::optional<T>& value)
    {
        return value ? nlohmann::json(*value) : nlohmann::json();
    }
    static nlohmann::json json_of(nlohmann::json value) { return value; }

    template <class Read>
    static nlohmann::json read_from(const Read& read, const RowFacts& facts)
    {
        const auto read_part = [&](const auto* part) {
            return part != nullptr ? json_of(std::invoke(read, *part)) : nlohmann::json();
        };
        const RowRun& row = *facts.row;
        if constexpr (std::is_invocable_v<Read, const RowFacts&>)
            return read_part(&facts);
        else if constexpr (std::is_invocable_v<Read, const RowKey&>)
            return read_part(&row.key);
        else if constexpr (std::is_invocable_v<Read, const RowRun&>)
            return read_part(&row);
        else if constexpr (std::is_invocable_v<Read, const Traced&>)
            return read_part(traced(row));
        else if constexpr (std::is_invocable_v<Read, const Visits&>)
            return read_part(traced(row) != nullptr && traced(row)->visits.rays > 0 ? &traced(row)->visits : nullptr);
        else if constexpr (std::is_invocable_v<Read, const Figures&>)
            return read_part(facts.figures ? &*facts.figures : nullptr);
        else {
            static_assert(std::is_invocable_v<Read, const Comparison&>, "a field is read from a part of a row");
            return read_part(facts.comparison ? &*facts.comparison : nullptr);
        }
    }

    std::function<nlohmann::json(const RowFacts&)> read_;
};

/// A value as it is, but true becomes "yes", and false, null and any non-scalar become an empty cell.
[[nodiscard]] Cell plain_cell(const nlohmann::json& value);

/// How a table shows a field: as a column with this title, or not at all.
struct Shown {
    const char* title = nullptr; ///< null: the table does not have the field
    const char* unit = "";
    int decimals = 2;
    Cell (*cell)(const nlohmann::json&) = plain_cell;
    const char* key = nullptr; ///< of the column; null: the field's
};

/// A field of a row, with everything that any output needs. A table has its columns in the order of row_fields().
struct RowField {
    const char* group = ""; ///< the object of the row's JSON that holds it, such as "times"; empty: the row itself
    const char* key = "";
    FieldValue value;
    const char* schema = nullptr; ///< JSON Schema, or the name of a definition in result.schema.json; null: not in JSON
    bool required = false;        ///< whether each such object has it
    const char* what = nullptr;   ///< for the schema's reader; null: the key explains itself
    Shown csv = {};               ///< column of `bench` as CSV and Markdown
    Shown check = {};             ///< the same of `check`
    Shown rates = {};             ///< column of the first table that `bench` prints
    Shown times = {};             ///< column of "where the time goes"
    Shown report = {};            ///< column of "Where the time goes" of `report`; the field is in JSON
};

/// Every field of a row, stated once: tables, CSV, Markdown, JSON, its schema and the page of `report` are generated
/// from this list. After a change, update results/result.schema.json by `cmake --build build/release --target
/// result_schema`.
[[nodiscard]] const std::vector<RowField>& row_fields();

/// The group whose fields are in `tetrace.ratios[]`, not in the row.
inline constexpr const char* ratio_group = "ratio";

using Place = Shown RowField::*;

/// The columns of the fields with this place. "{reference}" in a title is replaced.
[[nodiscard]] std::vector<Column> columns_of(Place place, const std::string& reference = "reference");

/// A row's cells for those columns.
[[nodiscard]] std::vector<Cell> cells_of(Place place, const RowFacts& facts);

} // namespace tetrace
