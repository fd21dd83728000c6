#pragma once

#include "bench/reproduce/tables/paper_table.h"
#include "bench/results/result_value.h"

namespace tetrace {

/// What `tetrace reproduce` found, as far as its result has it too.
struct PaperTables {
    std::vector<PaperTable> tables;
    std::vector<PaperFigure> figures;
    std::vector<std::string> missing_scenes, missing_devices; ///< a sentence each
    std::string trust = {}; ///< whether to trust the rates, which read_tables() does not know; empty without rates
    bool interrupted = false;
};

/// What `reproduce` prints, and `show` prints again.
[[nodiscard]] Sheet tables_sheet(const PaperTables& all);

/// The same as Markdown, in which claims are tables.
[[nodiscard]] std::string tables_markdown(const PaperTables& all);

/// The tables of a result's section `tetrace`: the reverse of table_json() and figure_json(). Throws
/// Error{invalid_input} naming the key that is missing or of another kind.
[[nodiscard]] PaperTables read_tables(const ResultValue& section);

} // namespace tetrace
