#include "bench/show/check_sheet.h"

#include "bench/measuring/conformity.h"
#include "bench/output/bench_report.h"
#include "bench/output/check_matrix.h"
#include "bench/output/report.h"

#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

/// With an empty line after it; nothing for an empty table.
void add_table(Sheet& sheet, const Table& table)
{
    if (table.rows().empty()) return;
    sheet.table(table);
    sheet.gap();
}

/// Devices that compute differently from what exact mode guarantees, each once.
std::set<std::string> inexact_devices(const std::vector<RowRecord>& rows)
{
    std::set<std::string> sentences;
    for (const RowRecord& row : rows)
        if (conformity_of(row) == Conformity::not_exact)
            sentences.insert(
                fmt::format("{}: its answers are openmp's here, but its self-test in exact mode found: {}; "
                            "other scenes may differ",
                            device_label(row.key), row.self_test->text()));
    return sentences;
}

} // namespace

RowFacts check_facts(const RowRecord& row)
{
    RowFacts facts(row);
    facts.conformity = conformity_text(row);
    return facts;
}

Table check_table(const std::vector<RowRecord>& rows)
{
    Table table(columns_of(&RowField::check));
    for (const RowRecord& row : rows)
        table.add(cells_of(&RowField::check, check_facts(row)));
    return table;
}

Sheet check_sheet(const CheckFindings& found)
{
    const auto& rows = *found.rows;
    Sheet sheet;
    for (const nlohmann::json& scene : found.scenes) {
        const ResultValue value(scene, "scene");
        const std::string name = value.at("name").line();
        sheet.heading(scene_headline(value));
        sheet.gap();
        add_table(sheet, matrix_table(name, rows));
        add_table(sheet, answers_table(name, rows));
    }
    add_table(sheet, self_test_table(rows));
    sheet.append(failure_lines(rows));
    for (const RowRecord& row : rows)
        sheet.verbatim(differences_text(row));
    for (const std::string& sentence : inexact_devices(rows))
        sheet.line(sentence);
    sheet.labelled("Verified", verdict_sentence(rows));
    if (found.interrupted) sheet.labelled("Stopped", interrupted_sentence);
    for (const std::string& sentence : found.missing)
        sheet.labelled("Missing", sentence);
    return sheet;
}

} // namespace tetrace
