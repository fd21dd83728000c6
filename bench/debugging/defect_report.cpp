#include "bench/debugging/defect_report.h"

#include "bench/output/junit.h"
#include "bench/rows/rows.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

std::string label_of(const DefectRun& run)
{
    return device_label({{}, run.backend, {}, RayKind::primary, TetOrder::hilbert, run.device_index});
}

std::string cell_text(const DefectRun& run)
{
    if (run.sight != DefectSight::seen) return std::string(name_of(run.sight));
    return fmt::format("SEEN: {} of {} items", run.wrong.size(), defect_items);
}

/// The first wrong word, or the reason; empty where all is well.
std::string detail_of(const DefectRun& run)
{
    if (run.sight != DefectSight::seen) return run.reason;
    const std::uint32_t item = run.wrong.front();
    return fmt::format("item {} returns {} instead of {}", item, run.first_word, run.defect->expected(item));
}

Table matrix(const std::vector<DefectRun>& runs)
{
    std::vector<Column> columns = {{"device", "device"}, {.key = "driver", .title = "driver", .rank = 2}};
    for (const Defect& defect : all_defects())
        columns.push_back(
            {.key = std::string(defect.name), .title = std::string(defect.name), .coloured = true, .rank = 0});
    Table table(columns);
    const std::size_t a_device = all_defects().size();
    for (std::size_t first = 0; first + a_device <= runs.size(); first += a_device) {
        std::vector<Cell> cells = {label_of(runs[first]), text_cell(runs[first].device.driver)};
        for (std::size_t i = first; i < first + a_device; ++i)
            cells.emplace_back(cell_text(runs[i]));
        table.add(std::move(cells));
    }
    return table;
}

Table all_runs_table(const std::vector<DefectRun>& runs)
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
    for (const DefectRun& run : runs)
        table.add({run.backend, std::uint64_t{run.device_index}, run.device.name, std::string(name_of(run.device.kind)),
                   text_cell(run.device.driver), text_cell(run.device.implementation), std::string(run.defect->name),
                   std::string(name_of(run.sight)), std::uint64_t{run.wrong.size()}, text_cell(detail_of(run))});
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
    if (!run.reason.empty()) object["reason"] = run.reason;
    if (run.sight != DefectSight::seen) return object;
    const std::uint32_t item = run.wrong.front();
    object["wrong_items"] = run.wrong;
    object["first_wrong"] = {{"item", item}, {"word", run.first_word}, {"expected", run.defect->expected(item)}};
    return object;
}

std::string summary(const std::vector<DefectRun>& runs)
{
    const auto count = [&](DefectSight sight) { return std::ranges::count(runs, sight, &DefectRun::sight); };
    return fmt::format("{} reduced kernels ran: {} of them show their defect; {} skipped, {} errors",
                       count(DefectSight::seen) + count(DefectSight::not_seen), count(DefectSight::seen),
                       count(DefectSight::skipped), count(DefectSight::error));
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

Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                     const Options& options)
{
    nlohmann::json section = result_head(options);
    section["defects"] = nlohmann::json::array();
    for (const DefectRun& run : runs)
        section["defects"].push_back(run_json(run));
    section["missing_devices"] = missing;
    Report report{{}, all_runs_table(runs), {{"tetrace", std::move(section)}}};
    report.sheet.table(matrix(runs), 0);
    report.sheet.gap();
    for (const Defect& defect : all_defects())
        report.sheet.prose(fmt::format("{}: {}. Known of: {}.", defect.name, defect.what, defect.known));
    report.sheet.gap();
    for (const DefectRun& run : runs)
        if (const std::string detail = detail_of(run); !detail.empty())
            report.sheet.line(fmt::format("{} on {}: {}", run.defect->name, label_of(run), detail));
    report.sheet.labelled("Verified", summary(runs));
    for (const std::string& sentence : missing)
        report.sheet.labelled("Missing", sentence);
    report.markdown = report.sheet.markdown();
    if (options.junit && *options.junit != "-") report.sheet.labelled("JUnit", options.junit->string());
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem)
{
    std::vector<JunitCase> cases;
    for (const DefectRun& run : runs)
        cases.push_back({run.backend, label_of(run), run.device.name, run.device.driver,
                         "defect/" + std::string(run.defect->name), outcome_of(run.sight), detail_of(run),
                         run.seconds});
    return junit_suite("defects", cases, problem);
}

} // namespace tetrace
