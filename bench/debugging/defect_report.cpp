#include "bench/debugging/defect_report.h"

#include "bench/output/junit.h"
#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "core/base/printable.h"
#include "core/base/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {

namespace {

void judge(DefectRun& run, const std::vector<std::uint32_t>& words)
{
    run.wrong = wrong_items(*run.defect, words);
    if (run.wrong.empty()) return;
    run.sight = DefectSight::seen;
    if (run.wrong.front() < words.size()) run.first_word = words[run.wrong.front()];
}

void run_on(DefectRun& run, Backend& runner)
{
    const Stopwatch watch;
    try {
        judge(run, runner.run_defect(run.device_index, run.defect->name));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        run.sight = DefectSight::error;
        run.kind = error.kind();
        run.reason = printable_text(error.what());
    } catch (const std::exception& error) {
        run.sight = DefectSight::error;
        run.reason = printable_text(error.what());
    }
    run.seconds = watch.seconds();
}

/// The devices of the rows that the options select, each once, as a row's key names them.
std::vector<RowKey> places(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<RowKey> found;
    for (const RowKey& key : select_rows(options, {"defects"}, backends)) {
        const auto is_there = [&](const RowKey& other) {
            return other.backend == key.backend && other.device == key.device;
        };
        if (std::ranges::none_of(found, is_there)) found.push_back(key);
    }
    return found;
}

} // namespace

std::vector<DefectRun> run_defects(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<DefectRun> runs;
    for (const RowKey& place : places(options, backends)) {
        Backend& backend = **std::ranges::find(backends, place.backend, &Backend::name);
        if (!backend.runs_defects()) continue; // Embree compiles nothing
        for (const Defect& defect : all_defects()) {
            DefectRun& run = runs.emplace_back();
            run.backend = place.backend;
            run.device_index = place.device;
            run.device = backend.devices().at(place.device);
            run.defect = &defect;
            if (run.device.usable) {
                progress_line().show("running reduced kernels", -1, -1, run.device.name);
                run_on(run, backend);
                continue;
            }
            run.sight = run.device.broken ? DefectSight::error : DefectSight::skipped;
            run.kind = run.device.broken ? ErrorKind::driver : ErrorKind::missing;
            run.reason = run.device.reason;
        }
    }
    progress_line().clear();
    return runs;
}

int exit_code(const std::vector<DefectRun>& runs)
{
    const auto has = [&](DefectSight sight) { return std::ranges::find(runs, sight, &DefectRun::sight) != runs.end(); };
    if (has(DefectSight::seen)) return exit_code(ErrorKind::wrong_result);
    for (const DefectRun& run : runs)
        if (run.sight == DefectSight::error) return exit_code(run.kind);
    return has(DefectSight::not_seen) ? 0 : exit_code(ErrorKind::missing);
}

namespace {

std::string label_of(const std::string& backend, std::size_t index)
{
    return device_label({{}, backend, {}, RayKind::primary, TetOrder::chains, index});
}

/// A reduced kernel on a device, as a result has it.
struct ShownRun {
    std::string defect, what, known, backend;
    std::uint64_t index = 0, items = 0, wrong = 0;
    std::string device, type, driver, implementation, outcome;
    std::string detail; ///< the first wrong word, or the reason; empty if all is well

    [[nodiscard]] std::string label() const { return label_of(backend, index); }
    [[nodiscard]] bool is_seen() const { return outcome == name_of(DefectSight::seen); }
};

std::string line_or_nothing(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? value->line() : std::string();
}

ShownRun read_run(const ResultValue& value)
{
    ShownRun run;
    run.defect = value.at("defect").line();
    run.what = value.at("what").line();
    run.known = value.at("known").line();
    run.backend = value.at("backend").line();
    run.index = value.at("device_index").count();
    run.items = value.at("items").count();
    run.device = value.at("device").line();
    run.type = value.at("type").line();
    run.driver = line_or_nothing(value, "driver");
    run.implementation = line_or_nothing(value, "implementation");
    run.outcome = value.at("outcome").line();
    run.detail = printable_text(value.text_at("reason"));
    if (!run.is_seen()) return run;
    run.wrong = value.at("wrong_items").items().size();
    const ResultValue first = value.at("first_wrong");
    run.detail = fmt::format("item {} returns {} instead of {}", first.at("item").count(), first.at("word").count(),
                             first.at("expected").count());
    return run;
}

std::string cell_text(const ShownRun& run)
{
    return run.is_seen() ? fmt::format("SEEN: {} of {} items", run.wrong, run.items) : run.outcome;
}

/// The runs of the first device: one of each defect.
std::vector<ShownRun> each_defect(const std::vector<ShownRun>& runs)
{
    std::vector<ShownRun> found;
    for (const ShownRun& run : runs)
        if (std::ranges::find(found, run.defect, &ShownRun::defect) == found.end()) found.push_back(run);
    return found;
}

Table matrix(const std::vector<ShownRun>& runs)
{
    std::vector<Column> columns = {{"device", "device"}, {.key = "driver", .title = "driver", .rank = 2}};
    const auto defects = each_defect(runs);
    for (const ShownRun& defect : defects)
        columns.push_back({.key = defect.defect, .title = defect.defect, .coloured = true, .rank = 0});
    Table table(columns);
    std::vector<std::string> shown;
    for (const ShownRun& first : runs) {
        if (std::ranges::find(shown, first.label()) != shown.end()) continue;
        shown.push_back(first.label());
        std::vector<Cell> cells = {first.label(), text_cell(first.driver)};
        for (const ShownRun& defect : defects) {
            const auto run = std::ranges::find_if(
                runs, [&](const ShownRun& one) { return one.label() == first.label() && one.defect == defect.defect; });
            cells.push_back(run == runs.end() ? Cell() : Cell(cell_text(*run)));
        }
        table.add(std::move(cells));
    }
    return table;
}

Table all_runs_table(const std::vector<ShownRun>& runs)
{
    Table table({{"backend", "backend"},
                 {"device_index", "index"},
                 {"device", "device"},
                 {"type", "type"},
                 {"driver", "driver"},
                 {"implementation", "implementation"},
                 {"defect", "defect"},
                 {"outcome", "outcome"},
                 {"wrong_items", "wrong items"},
                 {"detail", "detail"}});
    for (const ShownRun& run : runs)
        table.add({run.backend, run.index, run.device, run.type, text_cell(run.driver), text_cell(run.implementation),
                   run.defect, run.outcome, run.wrong, text_cell(run.detail)});
    return table;
}

nlohmann::json run_json(const DefectRun& run)
{
    nlohmann::json object = {
        {"defect", run.defect->name},       {"what", run.defect->what},         {"known", run.defect->known},
        {"backend", run.backend},           {"device_index", run.device_index}, {"device", run.device.name},
        {"type", name_of(run.device.kind)}, {"outcome", name_of(run.sight)},    {"items", defect_items}};
    if (!run.device.driver.empty()) object["driver"] = run.device.driver;
    if (!run.device.implementation.empty()) object["implementation"] = run.device.implementation;
    if (!run.device.library.empty()) object["library"] = run.device.library;
    if (!run.reason.empty()) object["reason"] = run.reason;
    if (run.sight != DefectSight::seen) return object;
    const std::uint32_t item = run.wrong.front();
    object["wrong_items"] = run.wrong;
    object["first_wrong"] = {{"item", item}, {"word", run.first_word}, {"expected", run.defect->expected(item)}};
    return object;
}

std::string summary(const std::vector<ShownRun>& runs)
{
    const auto count = [&](DefectSight sight) {
        return std::ranges::count(runs, std::string(name_of(sight)), &ShownRun::outcome);
    };
    return fmt::format("{} reduced kernels ran: {} show their defect; {} skipped, {} errors",
                       count(DefectSight::seen) + count(DefectSight::not_seen), count(DefectSight::seen),
                       count(DefectSight::skipped), count(DefectSight::error));
}

/// The first wrong word, or the reason; empty if all is well.
std::string detail_of(const DefectRun& run)
{
    if (run.sight != DefectSight::seen) return run.reason;
    const std::uint32_t item = run.wrong.front();
    return fmt::format("item {} returns {} instead of {}", item, run.first_word, run.defect->expected(item));
}

CaseOutcome outcome_of(DefectSight sight)
{
    switch (sight) {
    case DefectSight::not_seen: return CaseOutcome::passed;
    case DefectSight::seen: return CaseOutcome::failed;
    case DefectSight::skipped: return CaseOutcome::skipped;
    case DefectSight::error: return CaseOutcome::error;
    }
    return CaseOutcome::error;
}

} // namespace

ShownDefects shown_defects(const ResultValue& section)
{
    std::vector<ShownRun> runs;
    for (const ResultValue& run : section.at("defects").items())
        runs.push_back(read_run(run));
    ShownDefects shown{{}, all_runs_table(runs)};
    shown.sheet.table(matrix(runs), 0);
    shown.sheet.gap();
    for (const ShownRun& defect : each_defect(runs))
        shown.sheet.prose(fmt::format("{}: {}. Known in: {}.", defect.defect, defect.what, defect.known));
    shown.sheet.gap();
    for (const ShownRun& run : runs)
        if (!run.detail.empty()) shown.sheet.line(fmt::format("{} on {}: {}", run.defect, run.label(), run.detail));
    shown.sheet.labelled("Verified", summary(runs));
    for (const ResultValue& sentence : section.at("missing_devices").items())
        shown.sheet.labelled("Missing", printable_text(sentence.text()));
    return shown;
}

Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                     const Options& options)
{
    nlohmann::json section = result_head(options);
    section["defects"] = nlohmann::json::array();
    for (const DefectRun& run : runs)
        section["defects"].push_back(run_json(run));
    section["missing_devices"] = missing;
    const nlohmann::json json = {{"tetrace", std::move(section)}};
    ShownDefects shown = shown_defects(ResultValue(json, "the defects").at("tetrace"));
    Report report{std::move(shown.sheet), std::move(shown.table), json};
    report.markdown = report.sheet.markdown();
    if (options.junit && *options.junit != "-") report.sheet.labelled("JUnit", options.junit->string());
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem)
{
    std::vector<JunitCase> cases;
    for (const DefectRun& run : runs)
        cases.push_back({run.backend, label_of(run.backend, run.device_index), run.device.name, run.device.driver,
                         "defect/" + std::string(run.defect->name), outcome_of(run.sight), detail_of(run), run.seconds,
                         run.device.library});
    return junit_suite("defects", cases, problem);
}

} // namespace tetrace
