#include "bench/variants/variant_report.h"

#include "bench/expectations/check_verdict.h"
#include "bench/output/junit.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/text.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace tetrace {

namespace {

nlohmann::json failure_json(const VariantFailure& failure)
{
    nlohmann::json object = {{"number", failure.number},
                             {"outcome", name_of(failure.sight)},
                             {"changes", failure.changes},
                             {"reduced", failure.reduced},
                             {"tries", failure.tries}};
    if (failure.is_unfinished) object["unfinished"] = true;
    if (failure.same_as) object["same_as"] = *failure.same_as;
    if (failure.different > 0) object["different_rays"] = failure.different;
    if (const auto& ray = failure.first_different)
        object["first_different"] = {{"view", ray->view}, {"pixel", {ray->x, ray->y}}};
    if (!failure.reason.empty()) object["reason"] = failure.reason;
    if (!failure.command.empty()) object["command"] = failure.command;
    return object;
}

nlohmann::json row_json_of(const VariantRow& row)
{
    const Device& device = row.row.device;
    nlohmann::json object = {{"name", row.name},
                             {"backend", row.row.key.backend},
                             {"device_index", row.row.key.device},
                             {"device", device.name},
                             {"type", name_of(device.kind)},
                             {"changes", row.changes},
                             {"made", row.made},
                             {"ran", row.ran},
                             {"failures", nlohmann::json::array()}};
    if (!device.driver.empty()) object["driver"] = device.driver;
    if (!device.implementation.empty()) object["implementation"] = device.implementation;
    if (row.spilling) object["spilling"] = *row.spilling;
    if (!row.reason.empty()) object["reason"] = row.reason;
    if (row.fails_as_it_is) object["fails_as_it_is"] = true;
    for (const VariantFailure& failure : row.failures)
        object["failures"].push_back(failure_json(failure));
    return object;
}

std::uint64_t count_of(const ResultValue& row, VariantSight sight)
{
    const auto failures = row.at("failures").items();
    return static_cast<std::uint64_t>(std::ranges::count_if(
        failures, [&](const ResultValue& failure) { return failure.at("outcome").line() == name_of(sight); }));
}

Table table_of(const std::vector<ResultValue>& rows)
{
    Table table({{"name", "kernel"},
                 {.key = "device", .title = "device", .rank = 2},
                 {.key = "variants", .title = "variants", .rank = 0},
                 {.key = "changes_of_variant", .title = "changes", .decimals = 0},
                 {.key = "wrong", .title = "wrong", .rank = 0},
                 {.key = "not_compiled", .title = "not compiled", .rank = 0},
                 {.key = "not_run", .title = "not run", .rank = 0},
                 {.key = "fused", .title = "fused", .rank = 0},
                 {.key = "spilling", .title = "spilling", .rank = 0}});
    for (const ResultValue& row : rows) {
        const std::uint64_t ran = row.at("ran").count();
        const auto spilling = row.find("spilling"); // then it was compiled, and did not run
        const auto cell = [&](VariantSight sight, bool applies) {
            return applies ? Cell(count_of(row, sight)) : Cell();
        };
        table.add({row.at("name").line(), row.at("device").line(), ran,
                   ran == 0 ? Cell() : Cell(static_cast<double>(row.at("made").count()) / static_cast<double>(ran)),
                   cell(VariantSight::wrong, !spilling), count_of(row, VariantSight::not_compiled),
                   cell(VariantSight::not_run, !spilling), cell(VariantSight::fused, spilling.has_value()),
                   spilling ? Cell(spilling->count()) : Cell()});
    }
    return table;
}

std::string failure_text(const ResultValue& row, const ResultValue& failure)
{
    std::vector<std::string> reduced;
    for (const ResultValue& change : failure.at("reduced").items())
        reduced.push_back(change.line());
    std::string text = fmt::format("{}: variant {} is {}", row.at("name").line(), failure.at("number").count(),
                                   failure.at("outcome").line());
    if (const auto different = failure.find("different_rays"))
        text += fmt::format(" ({})", counted(different->count(), "ray", "rays"));
    const std::string changes = counted(failure.at("changes").count(), "change", "changes");
    if (reduced.empty())
        text += fmt::format("; its {} were not reduced", changes);
    else if (failure.find("unfinished"))
        text += fmt::format("; its {} were not reduced to fewer than {} when --budget or a signal ended that", changes,
                            reduced.size());
    else
        text += fmt::format("; of its {} are needed: {}", changes, fmt::join(reduced, ", "));
    if (const std::string reason = failure.text_at("reason"); !reason.empty())
        text += "; " + printable_line(reason.substr(0, std::min<std::size_t>(reason.find('\n'), 200)));
    return text;
}

/// Each cause once, with the variants that have it, too.
void add_failures(Sheet& sheet, const ResultValue& row)
{
    const auto failures = row.at("failures").items();
    for (const ResultValue& failure : failures) {
        if (failure.find("same_as")) continue;
        const std::uint64_t number = failure.at("number").count();
        const auto others = std::ranges::count_if(failures, [&](const ResultValue& other) {
            const auto same = other.find("same_as");
            return same && same->count() == number;
        });
        sheet.prose(failure_text(row, failure) +
                    (others == 0 ? "."
                                 : fmt::format("; and of {} more.",
                                               counted(static_cast<std::uint64_t>(others), "variant", "variants"))));
        if (const std::string command = failure.text_at("command"); !command.empty() && !failure.find("unfinished"))
            sheet.verbatim("  To get it: " + printable_line(command) + "\n");
    }
}

std::string summary_of(const std::vector<ResultValue>& rows)
{
    std::uint64_t ran = 0, spilling = 0;
    std::map<VariantSight, std::uint64_t> counts;
    for (const ResultValue& row : rows) {
        ran += row.at("ran").count();
        for (const VariantSight sight : values_of<VariantSight>())
            counts[sight] += count_of(row, sight);
        if (const auto count = row.find("spilling")) spilling += count->count();
    }
    const std::string all =
        fmt::format("{} of {}: ", counted(ran, "variant", "variants"), counted(rows.size(), "row", "rows"));
    if (std::ranges::any_of(rows, [](const ResultValue& row) { return row.find("spilling").has_value(); }))
        return all + fmt::format("{} not compiled, {} with fused operations in decisions, {} spilling",
                                 counts[VariantSight::not_compiled], counts[VariantSight::fused], spilling);
    return all + fmt::format("{} wrong, {} not compiled, {} not run", counts[VariantSight::wrong],
                             counts[VariantSight::not_compiled], counts[VariantSight::not_run]);
}

bool has_failed(const VariantRow& row)
{
    return row.fails_as_it_is || !row.failures.empty();
}

/// Empty if none ran.
std::optional<CheckVerdict> verdict_of(const std::vector<VariantRow>& rows)
{
    const bool has_unchanged = std::ranges::any_of(rows, &VariantRow::fails_as_it_is);
    CheckTally tally = has_unchanged ? CheckTally{"program", "programs"} : CheckTally{"variant", "variants"};
    for (const VariantRow& row : rows) {
        if (row.fails_as_it_is) tally.add(row.label, true);
        for (std::size_t i = 0; i < row.ran; ++i)
            tally.add(row.label, i < row.failures.size());
    }
    return tally.judged == 0 ? std::nullopt : std::optional(verdict_by_count(tally));
}

} // namespace

ShownVariants shown_variants(const ResultValue& section)
{
    const ResultValue variants = section.at("variants");
    const auto rows = variants.at("rows").items();
    ShownVariants shown{{}, table_of(rows)};
    shown.sheet.table(shown.table, 0);
    shown.sheet.gap();
    for (const ResultValue& row : rows) {
        add_failures(shown.sheet, row);
        if (const std::string reason = row.text_at("reason"); !reason.empty())
            shown.sheet.labelled(row.find("fails_as_it_is") ? "Failed" : "Skipped",
                                 fmt::format("{}: {}", row.at("name").line(), printable_line(reason)));
    }
    shown.sheet.labelled("Verified", summary_of(rows));
    if (const std::uint64_t asked = variants.at("asked").count(); std::ranges::any_of(
            rows, [&](const ResultValue& row) { return !row.find("reason") && row.at("ran").count() < asked; }))
        shown.sheet.labelled("Stopped", fmt::format("before all {} variants of each kernel were tried, by "
                                                    "--budget or a signal.",
                                                    with_commas(asked)));
    if (const auto missing = section.find("missing_devices"))
        for (const ResultValue& sentence : missing->items())
            shown.sheet.labelled("Missing", printable_text(sentence.text()));
    return shown;
}

Report variant_report(const std::vector<VariantRow>& rows, const std::vector<nlohmann::json>& scenes,
                      const std::vector<std::string>& missing, const Options& options)
{
    nlohmann::json section = result_head(options);
    if (options.verb == Verb::check) section["scenes"] = scenes;
    section["variants"] = {
        {"seed", options.seed.value_or(1)}, {"asked", options.variants}, {"rows", nlohmann::json::array()}};
    for (const VariantRow& row : rows)
        section["variants"]["rows"].push_back(row_json_of(row));
    if (options.verb == Verb::check) section["missing_devices"] = missing;
    set_verdict(section, verdict_of(rows));
    const nlohmann::json json = {{"tetrace", std::move(section)}};
    const ResultValue head = ResultValue(json, "the variants").at("tetrace");
    ShownVariants shown = shown_variants(head);
    Report report{std::move(shown.sheet), std::move(shown.table), json};
    Sheet document = report.sheet;
    document.append(verdict_line(head));
    report.markdown = document.markdown();
    if (options.junit && *options.junit != "-") report.sheet.labelled("JUnit", options.junit->string());
    if (options.out) report.sheet.labelled("Result", options.out->string());
    report.sheet.append(verdict_line(head));
    return report;
}

std::string variant_junit(const std::vector<VariantRow>& rows, const std::string& problem)
{
    std::vector<JunitCase> cases;
    for (const VariantRow& row : rows) {
        std::string reason = row.reason;
        for (const VariantFailure& failure : row.failures)
            reason += fmt::format("variant {}: {}: {} {}\n", failure.number, name_of(failure.sight),
                                  fmt::join(failure.reduced, ", "), failure.reason);
        const CaseOutcome outcome = has_failed(row) ? CaseOutcome::failed
                                    : row.ran == 0  ? CaseOutcome::skipped
                                                    : CaseOutcome::passed;
        const Device& device = row.row.device;
        cases.push_back({row.row.key.backend, row.label, device.name, device.driver, "variants/" + row.name, outcome,
                         reason, 0, fmt::format("{} variants", row.ran), device.library});
    }
    return junit_suite("variants", cases, problem);
}

int exit_code(const std::vector<VariantRow>& rows)
{
    if (std::ranges::any_of(rows, has_failed)) return exit_code(ErrorKind::wrong_result);
    const bool any_ran = std::ranges::any_of(rows, [](const VariantRow& row) { return row.ran > 0; });
    return any_ran ? 0 : exit_code(ErrorKind::missing);
}

} // namespace tetrace
