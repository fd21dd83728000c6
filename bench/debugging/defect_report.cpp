#include "bench/debugging/defect_report.h"

#include "bench/expectations/check_verdict.h"
#include "bench/output/junit.h"
#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "core/base/printable.h"
#include "core/base/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tetrace {

namespace {

void judge(DefectRun& run, const std::vector<std::uint32_t>& words)
{
    run.wrong = wrong_items(*run.defect, run.launch, words);
    if (run.wrong.empty()) {
        if (run.defect->is_flushed != nullptr && words != expected_words(*run.defect, run.launch))
            run.reason = "flushed: denormals count as zeros, which is allowed";
        return;
    }
    run.sight = DefectSight::seen;
    run.reason.clear();
    if (run.wrong.front() < words.size()) run.first_word = words[run.wrong.front()];
    run.expected_word = expected_words(*run.defect, run.launch)[run.wrong.front()];
}

void run_on(DefectRun& run, Backend& runner)
{
    const Stopwatch watch;
    try {
        for (const DefectLaunch& launch : run.defect->launches()) {
            run.launch = launch_on(run.device, *run.defect, launch);
            judge(run, runner.run_defect(run.device_index, run.defect->name, run.launch));
            if (run.sight == DefectSight::seen) break;
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        const bool is_lacking = error.kind() == ErrorKind::unsupported && run.defect->need != DefectNeed::none;
        run.sight = is_lacking ? DefectSight::skipped : DefectSight::error;
        if (is_lacking) run.launch = {0, 0};
        run.kind = error.kind();
        run.reason = printable_text(error.what());
    } catch (const std::exception& error) {
        run.sight = DefectSight::error;
        run.reason = printable_text(error.what());
    }
    run.seconds = watch.seconds();
}

bool is_wanted(const Options& options, const Defect& defect)
{
    return defect.is_stressor ? options.stress : options.defects || !options.stress;
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

namespace {

/// Empty if it did not run.
std::optional<DefectFinding> finding_of(const DefectRun& run)
{
    switch (run.sight) {
    case DefectSight::not_seen: return DefectFinding::right;
    case DefectSight::seen: return DefectFinding::wrong;
    case DefectSight::error: return DefectFinding::error;
    case DefectSight::skipped: return std::nullopt;
    }
    return std::nullopt;
}

void judge_by(DefectRun& run, const Expectations* expectations)
{
    const auto shown = finding_of(run);
    if (!shown) return;
    const Expectation* expectation = nullptr;
    if (expectations != nullptr)
        if (const auto found = expectations->find(run.device.implementation); found != expectations->end())
            expectation = &found->second;
    run.judged = judge_defect(expectation, std::string(run.defect->name), *shown);
}

} // namespace

std::vector<DefectRun> run_defects(const Options& options, const std::vector<Backend*>& backends,
                                   const Expectations* expectations)
{
    std::vector<DefectRun> runs;
    for (const RowKey& place : places(options, backends)) {
        Backend& backend = **std::ranges::find(backends, place.backend, &Backend::name);
        if (!backend.runs_defects()) continue; // Embree compiles nothing
        for (const Defect& defect : all_defects()) {
            if (!is_wanted(options, defect)) continue;
            DefectRun& run = runs.emplace_back();
            run.backend = place.backend;
            run.device_index = place.device;
            run.device = backend.devices().at(place.device);
            run.defect = &defect;
            if (run.device.usable) {
                progress_line().show(defect.is_stressor ? "running stressors" : "running reduced kernels", -1, -1,
                                     run.device.name);
                run_on(run, backend);
                continue;
            }
            run.sight = run.device.broken ? DefectSight::error : DefectSight::skipped;
            run.kind = run.device.broken ? ErrorKind::driver : ErrorKind::missing;
            run.reason = run.device.reason;
        }
    }
    progress_line().clear();
    for (DefectRun& run : runs)
        judge_by(run, expectations);
    return runs;
}

bool has_run_on(const std::string& backend, const std::vector<DefectRun>& runs)
{
    return std::ranges::any_of(
        runs, [&](const DefectRun& run) { return run.backend == backend && run.sight != DefectSight::skipped; });
}

int exit_code(const std::vector<DefectRun>& runs)
{
    int code = 0;
    for (const DefectRun& run : runs) {
        if (!fails(run.judged.judgement)) continue;
        if (run.sight != DefectSight::error) return exit_code(ErrorKind::wrong_result);
        if (code == 0) code = exit_code(run.kind);
    }
    const bool any_ran =
        std::ranges::any_of(runs, [](const DefectRun& run) { return run.sight != DefectSight::skipped; });
    return any_ran ? code : exit_code(ErrorKind::missing);
}

Expectations expectations_of(const std::vector<DefectRun>& runs)
{
    Expectations shown;
    for (const DefectRun& run : runs)
        if (const auto one = finding_of(run); one && !run.device.implementation.empty()) {
            auto& worst = shown[run.device.implementation].defects.emplace(run.defect->name, *one).first->second;
            worst = std::max(worst, *one);
        }
    return shown;
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
    std::uint64_t group_items = 0; ///< of a stressor that was launched
    std::uint64_t large_words = 0; ///< of the largest buffer that the device admits, if it has one
    std::string device, type, driver, implementation, outcome;
    std::string detail;    ///< the first wrong word, or the reason; empty if all is as it should be
    bool is_known = false; ///< whether seeing it was expected

    [[nodiscard]] std::string label() const { return label_of(backend, index); }
    [[nodiscard]] bool is_seen() const { return outcome == name_of(DefectSight::seen); }
};

std::string line_or_nothing(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? value->line() : std::string();
}

/// place: in the output, which may have words of all groups after those of the items.
std::string wrong_text(std::uint64_t place, std::uint64_t items, std::uint64_t word, std::uint64_t expected)
{
    if (place >= items) return fmt::format("word {} is {} instead of {}", place, word, expected);
    return fmt::format("item {} returns {} instead of {}", place, word, expected);
}

/// Of a stressor: the launch that was wrong or failed, to append; nothing if there was none.
std::string launch_text(std::string_view name, std::uint64_t items, std::uint64_t group_items,
                        std::uint64_t large_words)
{
    if (group_items == 0) return {};
    return fmt::format(" (dump --defect {}:{}:{}{})", name, items, group_items,
                       large_words == 0 ? "" : fmt::format(":{}", large_words));
}

/// 0 if the kernel has no buffer whose size the device decides.
std::uint32_t decided_words(const DefectRun& run)
{
    return run.defect->need == DefectNeed::largest_buffer ? run.launch.large_words : 0;
}

bool is_stressor(std::string_view name)
{
    const auto defect = std::ranges::find(all_defects(), name, &Defect::name);
    return defect != all_defects().end() && defect->is_stressor;
}

ShownRun read_run(const ResultValue& value)
{
    ShownRun run;
    run.defect = value.at("defect").line();
    run.what = value.at("what").line();
    run.known = value.at("known").line();
    run.backend = value.at("backend").line();
    run.index = value.at("device_index").count();
    if (const auto items = value.find("items")) run.items = items->count();
    if (const auto group = value.find("group_items")) run.group_items = group->count();
    if (const auto words = value.find("large_words")) run.large_words = words->count();
    run.device = value.at("device").line();
    run.type = value.at("type").line();
    run.driver = line_or_nothing(value, "driver");
    run.implementation = line_or_nothing(value, "implementation");
    run.outcome = value.at("outcome").line();
    run.detail = printable_text(value.text_at("reason"));
    const std::string launch = launch_text(run.defect, run.items, run.group_items, run.large_words);
    if (run.outcome == name_of(DefectSight::error)) run.detail += launch;
    if (!run.is_seen()) return run;
    const auto count = value.find("wrong"); // wrong_items has only the first
    run.wrong = count ? count->count() : value.at("wrong_items").items().size();
    const ResultValue first = value.at("first_wrong");
    run.detail =
        wrong_text(first.at("item").count(), run.items, first.at("word").count(), first.at("expected").count()) +
        launch;
    return run;
}

std::string cell_text(const ShownRun& run)
{
    if (!run.is_seen()) return run.outcome;
    const std::string_view seen = run.is_known ? "known" : "SEEN";
    if (run.wrong > run.items) return fmt::format("{}: {} words", seen, with_commas(run.wrong));
    return fmt::format("{}: {} of {} items", seen, with_commas(run.wrong), with_commas(run.items));
}

/// "defect/loop_of_70000_iterations": its name among test cases and deviations.
std::string case_name(std::string_view defect)
{
    return "defect/" + std::string(defect);
}

void mark_known(std::vector<ShownRun>& runs, const ResultValue& section)
{
    const auto expectations = section.find("expectations");
    if (!expectations) return;
    for (const ResultValue& one : expectations->at("deviations").items())
        for (ShownRun& run : runs)
            run.is_known = run.is_known ||
                           (one.at("name").line() == case_name(run.defect) && one.at("device").line() == run.label() &&
                            one.at("judgement").line() == name_of(Judgement::known_failure));
}

/// The runs of the first device: one of each defect.
std::vector<ShownRun> each_defect(const std::vector<ShownRun>& runs)
{
    std::vector<ShownRun> found;
    for (const ShownRun& run : runs)
        if (std::ranges::find(found, run.defect, &ShownRun::defect) == found.end()) found.push_back(run);
    return found;
}

/// The runs of the first defect: one of each device.
std::vector<ShownRun> each_device(const std::vector<ShownRun>& runs)
{
    std::vector<ShownRun> found;
    for (const ShownRun& run : runs)
        if (std::ranges::find(found, run.label(), &ShownRun::label) == found.end()) found.push_back(run);
    return found;
}

Table matrix(const std::vector<ShownRun>& runs)
{
    std::vector<Column> columns = {{"kernel", "kernel"}};
    const auto devices = each_device(runs);
    for (const ShownRun& device : devices)
        columns.push_back({.key = device.label(), .title = device.label(), .coloured = true, .rank = 0});
    Table table(columns);
    for (const ShownRun& defect : each_defect(runs)) {
        std::vector<Cell> cells = {defect.defect};
        for (const ShownRun& device : devices) {
            const auto run = std::ranges::find_if(runs, [&](const ShownRun& one) {
                return one.label() == device.label() && one.defect == defect.defect;
            });
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
    nlohmann::json object = {{"defect", run.defect->name},       {"what", run.defect->what},
                             {"known", run.defect->known},       {"backend", run.backend},
                             {"device_index", run.device_index}, {"device", run.device.name},
                             {"type", name_of(run.device.kind)}, {"outcome", name_of(run.sight)}};
    if (run.launch.items != 0) object["items"] = run.launch.items;
    if (run.launch.items != 0 && run.defect->is_stressor) object["group_items"] = run.launch.group_items;
    if (decided_words(run) != 0) object["large_words"] = decided_words(run);
    if (!run.device.driver.empty()) object["driver"] = run.device.driver;
    if (!run.device.implementation.empty()) object["implementation"] = run.device.implementation;
    if (!run.device.library.empty()) object["library"] = run.device.library;
    if (!run.reason.empty()) object["reason"] = run.reason;
    if (run.sight != DefectSight::seen) return object;
    const std::uint32_t item = run.wrong.front();
    constexpr std::size_t max_listed = 64;
    object["wrong_items"] = std::vector(run.wrong.begin(), run.wrong.begin() + std::min(run.wrong.size(), max_listed));
    object["wrong"] = run.wrong.size();
    object["first_wrong"] = {{"item", item}, {"word", run.first_word}, {"expected", run.expected_word}};
    return object;
}

std::string summary(const std::vector<ShownRun>& runs)
{
    const auto count = [&](DefectSight sight) {
        return std::ranges::count(runs, std::string(name_of(sight)), &ShownRun::outcome);
    };
    const bool stresses = std::ranges::any_of(runs, is_stressor, &ShownRun::defect);
    return fmt::format(
        "{} {} ran: {} {}; {} skipped, {} errors", count(DefectSight::seen) + count(DefectSight::not_seen),
        stresses ? "kernels" : "reduced kernels", count(DefectSight::seen),
        stresses ? "have wrong results" : "show their defect", count(DefectSight::skipped), count(DefectSight::error));
}

/// The first wrong word, or the reason; empty if all is as it should be.
std::string detail_of(const DefectRun& run)
{
    const std::string launch = run.defect->is_stressor ? launch_text(run.defect->name, run.launch.items,
                                                                     run.launch.group_items, decided_words(run))
                                                       : "";
    if (run.sight == DefectSight::error) return run.reason + launch;
    if (run.sight != DefectSight::seen) return run.reason;
    const std::uint32_t item = run.wrong.front();
    return wrong_text(item, run.launch.items, run.first_word, run.expected_word) + launch;
}

CaseOutcome outcome_of(const DefectRun& run)
{
    if (run.sight == DefectSight::skipped) return CaseOutcome::skipped;
    if (!fails(run.judged.judgement)) return CaseOutcome::passed;
    return run.sight == DefectSight::error ? CaseOutcome::error : CaseOutcome::failed;
}

/// Why it fails; of an unexpected pass that it is one.
std::string reason_of(const DefectRun& run)
{
    return run.judged.judgement == Judgement::unexpected_pass ? run.judged.text() : detail_of(run);
}

/// What is judged by name; empty if it simply conforms, or fails without having been expected.
std::string judged_text(const DefectRun& run)
{
    const Judgement judgement = run.judged.judgement;
    return judgement == Judgement::conforms || judgement == Judgement::failure ? std::string() : run.judged.text();
}

std::vector<Deviation> deviations_of(const std::vector<DefectRun>& runs)
{
    std::vector<Deviation> deviations;
    for (const DefectRun& run : runs)
        if (run.judged.judgement != Judgement::conforms)
            deviations.push_back({case_name(run.defect->name), label_of(run.backend, run.device_index),
                                  run.device.implementation, run.judged});
    return deviations;
}

/// Those with a finding.
std::set<std::string> implementations_of(const std::vector<DefectRun>& runs)
{
    std::set<std::string> implementations;
    for (const DefectRun& run : runs)
        if (finding_of(run)) implementations.insert(run.device.implementation);
    return implementations;
}

std::vector<std::string> unmentioned_of(const std::vector<DefectRun>& runs, const Expectations& expectations)
{
    auto implementations = implementations_of(runs);
    std::erase_if(implementations, [&](const std::string& name) { return expectations.contains(name); });
    return {implementations.begin(), implementations.end()};
}

/// Sentences on defects that files expect of implementations of this run, and that tetrace does not have.
std::vector<std::string> unknown_of(const std::vector<DefectRun>& runs, const Expectations& expectations)
{
    std::set<std::string> sentences;
    for (const DefectRun& run : runs) {
        const auto expectation = expectations.find(run.device.implementation);
        if (expectation == expectations.end()) continue;
        for (const auto& [name, shown] : expectation->second.defects)
            if (std::ranges::find(all_defects(), name, &Defect::name) == all_defects().end())
                sentences.insert(fmt::format("{}: defects.{}: no reduced kernel or stressor has this name",
                                             expectation->second.file, name));
    }
    return {sentences.begin(), sentences.end()};
}

/// Empty if none ran and none had to. A required backend on which none ran fails with each kernel that was wanted.
std::optional<CheckVerdict> verdict_on(const std::vector<DefectRun>& runs, const Options& options,
                                       bool has_expectations)
{
    CheckTally tally{options.stress ? "kernel" : "reduced kernel", options.stress ? "kernels" : "reduced kernels"};
    for (const DefectRun& run : runs)
        if (finding_of(run)) tally.add(label_of(run.backend, run.device_index), fails(run.judged.judgement));
    const std::size_t answered = tally.judged;
    for (const std::string& backend : options.required)
        for (const Defect& defect : all_defects())
            if (is_wanted(options, defect) && !has_run_on(backend, runs)) tally.add(backend, true);
    if (tally.judged == 0) return std::nullopt;
    return has_expectations ? verdict_by_expectations(tally, deviations_of(runs), tally.judged - answered)
                            : verdict_by_count(tally);
}

} // namespace

ShownDefects shown_defects(const ResultValue& section, const Sheet& files)
{
    std::vector<ShownRun> runs;
    for (const ResultValue& run : section.at("defects").items())
        runs.push_back(read_run(run));
    mark_known(runs, section);
    ShownDefects shown{{}, all_runs_table(runs)};
    shown.sheet.table(matrix(runs), 0);
    shown.sheet.gap();
    for (const ShownRun& device : each_device(runs))
        shown.sheet.line(fmt::format("{}: {}, {}", device.label(), device.device, device.driver));
    shown.sheet.gap();
    for (const ShownRun& defect : each_defect(runs))
        shown.sheet.prose(fmt::format("{}: {}. {}: {}.", defect.defect, defect.what,
                                      is_stressor(defect.defect) ? "Reports of the kind" : "Known in", defect.known));
    shown.sheet.gap();
    for (const ShownRun& run : runs)
        if (!run.detail.empty()) shown.sheet.line(fmt::format("{} on {}: {}", run.defect, run.label(), run.detail));
    shown.sheet.labelled("Verified", summary(runs));
    for (const ResultValue& sentence : section.at("missing_devices").items())
        shown.sheet.labelled("Missing", printable_text(sentence.text()));
    shown.sheet.append(expectation_lines(section));
    shown.sheet.append(files);
    shown.sheet.append(verdict_line(section));
    return shown;
}

Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                     const Options& options, const Expectations* expectations,
                     const std::vector<std::filesystem::path>& written)
{
    nlohmann::json section = result_head(options);
    section["defects"] = nlohmann::json::array();
    for (const DefectRun& run : runs)
        section["defects"].push_back(run_json(run));
    section["missing_devices"] = missing;
    if (expectations != nullptr)
        set_expectations(section, *expectations, implementations_of(runs), deviations_of(runs),
                         unmentioned_of(runs, *expectations), unknown_of(runs, *expectations));
    set_verdict(section, verdict_on(runs, options, expectations != nullptr));
    const nlohmann::json json = {{"tetrace", std::move(section)}};
    Sheet files;
    for (const auto& file : written)
        files.labelled("Written", file.string());
    if (options.junit && *options.junit != "-") files.labelled("JUnit", options.junit->string());
    if (options.out) files.labelled("Result", options.out->string());
    const ResultValue defects = ResultValue(json, "the defects").at("tetrace");
    ShownDefects shown = shown_defects(defects, files);
    Report report{std::move(shown.sheet), std::move(shown.table), json};
    report.markdown = shown_defects(defects).sheet.markdown();
    return report;
}

std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem)
{
    std::vector<JunitCase> cases;
    for (const DefectRun& run : runs)
        cases.push_back({run.backend, label_of(run.backend, run.device_index), run.device.name, run.device.driver,
                         case_name(run.defect->name), outcome_of(run), reason_of(run), run.seconds, judged_text(run),
                         run.device.library});
    return junit_suite("defects", cases, problem);
}

} // namespace tetrace
