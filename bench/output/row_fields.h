#pragma once

#include "bench/output/field_value.h"
#include "bench/results/row_keys.h"
#include "bench/terminal/table.h"

namespace tetrace {

/// A value as it is, but true becomes "yes", and false, null and any non-scalar become an empty cell.
[[nodiscard]] Cell plain_cell(const nlohmann::json& value);

/// How a table shows a field: as a column with this title, or not at all.
struct Shown {
    const char* title = nullptr; ///< null: the table does not have the field
    const char* unit = "";
    int decimals = 2;
    Cell (*cell)(const nlohmann::json&) = plain_cell;
    const char* key = nullptr; ///< of the column; null: the field's
    int rank = 1;              ///< of the column, see Column
};

/// How results have a field in JSON.
struct Recorded {
    const char* schema = nullptr; ///< JSON Schema, or the name of a definition in result.schema.json; null: not in JSON
    bool required = false;        ///< whether each such object has it
    const char* what = nullptr;   ///< for the schema's reader; null: the key explains itself
};

struct PlacedColumn;

/// A field of a row, with everything that any output needs. A table has its columns in the order of row_fields().
struct RowField : RowPath, Recorded {
    /// outputs: a Recorded where JSON has the field, and a PlacedColumn for each table that has it.
    template <class... Output>
    RowField(const RowPath& path, FieldValue read, const Output&... outputs) : RowPath(path), value(std::move(read))
    {
        (add(outputs), ...);
    }
    /// The same for a key that no other code names.
    template <class... Output>
    RowField(const char* in_group, const char* with_key, FieldValue read, const Output&... outputs)
        : RowField(RowPath{in_group, with_key}, std::move(read), outputs...)
    {
    }

    FieldValue value;
    Shown csv;    ///< column of `bench` as CSV and Markdown
    Shown check;  ///< the same of `check`
    Shown rates;  ///< column of the first table that `bench` prints
    Shown times;  ///< column of "where the time goes"
    Shown report; ///< column of "Where the time goes" of `report`; the field is in JSON

private:
    void add(const Recorded& recorded) { static_cast<Recorded&>(*this) = recorded; }
    void add(const PlacedColumn& column);
};

using Place = Shown RowField::*;

/// The column of one table.
struct PlacedColumn {
    Place place;
    Shown shown;
};

inline void RowField::add(const PlacedColumn& column)
{
    this->*column.place = column.shown;
}

/// Every field of a row, stated once: tables, CSV, Markdown, JSON, its schema and the page of `report` are generated
/// from this list. After a change, update results/result.schema.json by `cmake --build build/release --target
/// result_schema`.
[[nodiscard]] const std::vector<RowField>& row_fields();

/// The group whose fields are in `tetrace.ratios[]`, not in the row.
inline constexpr const char* ratio_group = "ratio";

/// The columns of the fields with this place. "{reference}" in a title is replaced.
[[nodiscard]] std::vector<Column> columns_of(Place place, const std::string& reference = "reference");

/// A row's cells for those columns.
[[nodiscard]] std::vector<Cell> cells_of(Place place, const RowFacts& facts);

/// A row's speed compared with others: its reference under another API, the fastest BVH, Embree's single rays.
[[nodiscard]] std::vector<RowField> comparison_fields();

/// What made the row's result, on what and when, and its rays: the same in all rows, so that CSV of several results can
/// be put together.
[[nodiscard]] std::vector<RowField> origin_fields();

/// The place of a field in a row's JSON, made if the row lacks it.
[[nodiscard]] nlohmann::json& field_in(nlohmann::json& row, const RowPath& path);

/// A row as results record it: those fields of row_fields() for which it has a value.
[[nodiscard]] nlohmann::json row_json(const RowFacts& facts);

/// A row's speed compared with its reference's. Precondition: facts.comparison.
[[nodiscard]] nlohmann::json ratio_json(const RowFacts& facts);

} // namespace tetrace
