#include "bench/show/show_report.h"

#include "bench/expectations/check_verdict.h"
#include "bench/measuring/conformity.h"
#include "bench/output/bench_report.h"
#include "bench/output/brief.h"
#include "bench/output/check_matrix.h"
#include "bench/output/report.h"
#include "bench/show/recorded_rows.h"
#include "bench/terminal/text.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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

Table check_table(const std::vector<RowRecord>& rows, const RunOrigin& origin)
{
    Table table(columns_of(&RowField::check));
    for (const RowRecord& row : rows) {
        RowFacts facts = check_facts(row);
        facts.origin = &origin;
        table.add(cells_of(&RowField::check, facts));
    }
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
        if (!found.known.contains(row_name(row.key))) sheet.verbatim(differences_text(row));
    for (const std::string& sentence : inexact_devices(rows))
        sheet.line(sentence);
    for (const RowRecord& row : rows)
        if (const std::string rate = rate_text(row); !rate.empty())
            sheet.line(fmt::format("{}: differs between repetitions: {}", row_name(row.key), rate));
    sheet.labelled("Verified", verdict_sentence(rows));
    if (found.interrupted) sheet.labelled("Stopped", interrupted_sentence);
    for (const std::string& sentence : found.missing)
        sheet.labelled("Missing", sentence);
    return sheet;
}

namespace {

std::vector<std::string> sentences_at(const ResultValue& section, const char* key)
{
    std::vector<std::string> sentences;
    if (const auto list = section.find(key))
        for (const ResultValue& sentence : list->items())
            sentences.push_back(printable_text(sentence.text()));
    return sentences;
}

std::vector<nlohmann::json> scenes_of(const ResultValue& section)
{
    std::vector<nlohmann::json> scenes;
    for (const ResultValue& scene : section.at("scenes").items())
        scenes.push_back(scene.json());
    return scenes;
}

RunAgain bench_again(const ResultFile& file, bool brief)
{
    const ResultValue section = file.section();
    BenchResult result;
    result.rows = read_rows(file);
    result.devices = read_devices(file, result.rows);
    result.comparisons = compare_rows(result.rows);
    result.best_bvhs = compare_with_best_bvh(result.rows);
    result.scenes = scenes_of(section);
    result.missing_scenes = sentences_at(section, "missing_scenes");
    result.missing_devices = sentences_at(section, "missing_devices");
    result.interrupted = section.find("interrupted").has_value();
    result.threads = small_count(section.at("threads"));
    result.measurement = read_measurement(section);
    result.conditions = read_steadiness(section).conditions;
    if (const auto asked = section.find("samples_asked")) result.samples_asked = small_count(*asked);
    if (const auto budget = section.find("budget_s")) result.budget_s = budget->number();
    Sheet sheet = brief ? brief_sheet(result) : bench_sheet(result);
    if (!brief && !section.find("timed_s") && is_timed(result))
        sheet.labelled("Not here", "how long the run took, how many samples were asked for, the size of the tets, and "
                                   "which APIs had no device: the result is of a version that did not record them.");
    return {std::move(sheet), flat_table(result, RunOrigin(section))};
}

RunAgain check_again(const ResultFile& file)
{
    const ResultValue section = file.section();
    const std::vector<RowRecord> rows = read_rows(file);
    Sheet sheet = check_sheet({&rows, scenes_of(section), sentences_at(section, "missing_devices"),
                               section.find("interrupted").has_value(), known_failures(section)});
    sheet.append(expectation_lines(section));
    sheet.append(verdict_line(section));
    return {std::move(sheet), check_table(rows, RunOrigin(section))};
}

} // namespace

RunAgain run_again(const ResultFile& file, bool brief)
{
    if (file.head.verb == "bench") return bench_again(file, brief);
    if (file.head.verb == "check") return check_again(file);
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("showing '{}', of 'tetrace {}': results of bench, check, reproduce and trace can be shown again",
                    file.path.string(), file.head.verb));
}

} // namespace tetrace
