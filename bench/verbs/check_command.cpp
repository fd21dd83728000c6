#include "bench/expectations/check_verdict.h"
#include "bench/expectations/expectation_files.h"
#include "bench/measuring/conformity.h"
#include "bench/measuring/ray_walks.h"
#include "bench/measuring/run_journal.h"
#include "bench/measuring/scene_rows.h"
#include "bench/options/identity.h"
#include "bench/output/array_folder.h"
#include "bench/output/check_matrix.h"
#include "bench/output/difference_pictures.h"
#include "bench/output/junit.h"
#include "bench/output/report.h"
#include "bench/output/row_fields.h"
#include "bench/show/show_report.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/kept_parts.h"
#include "core/base/files.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// Without pictures, arrays, expectations and their target where none were asked for.
struct Checked {
    std::optional<Expectations> expectations;
    std::optional<ExpectationTarget> target;
    std::vector<RowRecord> rows;
    CheckJudgement judgement;           ///< of the rows
    std::vector<nlohmann::json> scenes; ///< as results record them
    std::vector<std::string> missing;
    std::unique_ptr<DifferencePictures> pictures;
    std::unique_ptr<ArrayFolder> arrays;
};

/// Empty if the check was interrupted.
std::optional<CheckVerdict> verdict_of(const Checked& checked, const Options& options)
{
    return is_interrupted() ? std::nullopt : verdict_of(checked.rows, checked.judgement, options.required);
}

nlohmann::json check_json(const Checked& checked, const Options& options)
{
    nlohmann::json section = result_head(options);
    section["scenes"] = checked.scenes;
    section["matrix"] = matrix_json(checked.rows);
    section["rows"] = nlohmann::json::array();
    for (const RowRecord& row : checked.rows)
        section["rows"].push_back(row_json(check_facts(row)));
    section["missing_devices"] = checked.missing;
    set_verdict(section, verdict_of(checked, options));
    if (checked.expectations && !is_interrupted())
        set_expectations(section, *checked.expectations, implementations_of(checked.judgement),
                         checked.judgement.deviations, unmentioned_of(checked.judgement),
                         unknown_of(checked.judgement));
    return {{"tetrace", std::move(section)}};
}

/// written: the files of --write-expect.
Report check_report(const Checked& checked, const std::vector<std::filesystem::path>& written, const Options& options)
{
    const auto& rows = checked.rows;
    nlohmann::json json = check_json(checked, options);
    const ResultValue section = ResultValue(json, "the check").at("tetrace");
    Report report{{}, check_table(rows, RunOrigin(section)), {}};
    report.sheet = check_sheet({&rows, checked.scenes, checked.missing, is_interrupted(), known_failures(section)});
    report.sheet.append(expectation_lines(section));
    report.json = std::move(json);
    const auto verdict = verdict_of(checked, options);
    const Sheet last = verdict ? verdict->line() : Sheet();
    Sheet document = report.sheet;
    document.append(last);
    report.markdown = document.markdown({.columns = options.columns});
    if (checked.pictures != nullptr)
        for (const auto& file : checked.pictures->files())
            report.sheet.labelled("Picture", file.string());
    if (checked.arrays != nullptr) report.sheet.labelled("Arrays", checked.arrays->path().string());
    for (const auto& file : written)
        report.sheet.labelled("Written", file.string());
    if (options.junit && !prints_junit(options)) report.sheet.labelled("JUnit", options.junit->string());
    if (options.out) report.sheet.labelled("Result", options.out->string());
    report.sheet.append(last); // after the names of files
    return report;
}

bool has_only_foreign_kernels(const std::string& backend)
{
    return std::ranges::none_of(all_kernels(), [&](const KernelId& kernel) {
        return is_portable(kernel) && backend_named(backend).has_kernel(kernel);
    });
}

/// Rows of Embree's own BVH and of drivers' are judged only where asked for: they make no claim to break.
Options with_default_layouts(Options options)
{
    const auto& required = options.required;
    const bool asked = !options.structures.empty() || !options.methods.empty() || !options.layouts.empty() ||
                       !options.backends.empty() || !options.filter.empty() ||
                       std::ranges::any_of(required, has_only_foreign_kernels) ||
                       std::ranges::find(options.schedules, Schedule::pipeline) != options.schedules.end();
    if (asked) return options;
    for (const KernelId& kernel : all_kernels())
        if (is_portable(kernel)) options.layouts.push_back(kernel.layout);
    return options;
}

/// The rows of one repetition. journal: of its views; may be null.
std::vector<RowRecord> verify_once(const std::vector<RowKey>& keys, const Options& options, Journal* journal,
                                   Checked& checked)
{
    Budget budget(options.budget_s);
    SceneRows run = open_and_verify(keys, options,
                                    [&](const SeenImage& image) {
                                        if (checked.pictures != nullptr) checked.pictures->see(image);
                                        if (checked.arrays != nullptr) checked.arrays->see(image);
                                    },
                                    {journal, nullptr, nullptr, &budget});
    for (RowRun& row : run.rows)
        note_walks(row);
    checked.scenes = scene_records(run, options);
    return records_of(run.rows);
}

/// Does the check as often as --repeat says. An interrupted repetition counts only if it is the first. The journal has
/// each view once, so of several repetitions it has each as a whole.
void verify_all(const std::vector<RowKey>& keys, const Options& options, Journal* journal, Checked& checked)
{
    const bool repeats = options.repeat > 1;
    KeptParts kept(repeats ? journal : nullptr, options);
    std::vector<std::vector<RowRecord>> repetitions;
    std::vector<nlohmann::json> kept_scenes;
    for (unsigned i = 1; i <= options.repeat && (i == 1 || !is_interrupted()); ++i) {
        const std::string name = fmt::format("repetition {}", i);
        if (auto part = kept.find(name, keys)) {
            kept.require_same(part->scenes, kept_scenes);
            repetitions.push_back(std::move(part->rows));
            checked.scenes = kept_scenes = std::move(part->scenes);
            continue;
        }
        try {
            auto rows = verify_once(keys, options, repeats ? nullptr : journal, checked);
            kept.require_same(checked.scenes, kept_scenes);
            const bool is_whole = !is_interrupted();
            if (is_whole) kept.keep(name, {rows, checked.scenes, {}});
            if (is_whole || i == 1) repetitions.push_back(std::move(rows));
        } catch (const Error& error) {
            if (i == 1 || error.kind() != ErrorKind::interrupted) throw; // else it had no answer yet
        }
    }
    checked.rows = combined_rows(repetitions, options.allow_flawed);
    checked.judgement =
        judge_rows(checked.rows, checked.expectations ? &*checked.expectations : nullptr, options.allow_flawed);
}

std::vector<std::filesystem::path> write_expectations(Checked& checked, const Options& options)
{
    if (!checked.target) return {};
    if (!is_interrupted()) return checked.target->write(expectations_of(checked.rows, options.allow_flawed));
    say("tetrace: --write-expect: nothing is written, because the check was interrupted");
    return {};
}

/// checked: also what is done if the check ends early.
int check(const Options& options, Checked& checked)
{
    require_devices(options.required); // first: its reason for an empty selection is better
    const auto keys = selected_rows(options, [](const std::string&) { return true; });
    require_selected(keys, options);
    check_columns(options, check_columns_of(keys));
    for (const std::string& sentence : missing_default_scenes(options))
        say(sentence);
    checked.missing = missing_devices(options);
    if (options.picture_folder) checked.pictures = std::make_unique<DifferencePictures>(*options.picture_folder);
    checked.arrays = make_array_folder(options);
    nlohmann::json head = run_head(options, keys);
    head["repeats"] = options.repeat > 1; // then it keeps repetitions, not views
    const auto journal = open_journal(options, head);
    if (journal != nullptr) say_how_to_go_on(options);
    verify_all(keys, options, journal.get(), checked);
    const auto written = write_expectations(checked, options);
    deliver_besides_junit(options, check_report(checked, written, options));
    if (is_interrupted()) return end_interrupted();
    end_journal(journal.get(), options);
    require_judged(checked.rows, checked.judgement, options.required);
    require_answers(checked.rows, "checked");
    return exit_code(checked.rows, checked.judgement);
}

int list_selected(const Options& options)
{
    for (const RowKey& key : selected_rows(options, [](const std::string&) { return true; }))
        print(row_name(key) + "\n");
    return 0;
}

} // namespace

bool prints_junit(const Options& options)
{
    return options.junit && *options.junit == "-";
}

void require_selected(const std::vector<RowKey>& keys, const Options& options)
{
    for (const std::string& name : options.required)
        if (std::ranges::none_of(keys, [&](const RowKey& key) { return key.backend == name; }))
            throw Error(ErrorKind::missing,
                        fmt::format("--require {0}: no row of {0} is selected, so none would be judged; 'tetrace {1} "
                                    "--list' with the same options prints those that are",
                                    name, options.verb == Verb::check ? "check" : "bench"));
}

void require_judged(const std::vector<RowRecord>& rows, const CheckJudgement& judgement,
                    const std::vector<std::string>& backends)
{
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RowRecord& row = rows[i];
        const bool required = std::ranges::find(backends, row.key.backend) != backends.end();
        const Status status = status_of(row);
        if (required && (status == Status::skipped || status == Status::unsupported) &&
            !judgement.rows[i].is_as_expected())
            throw Error(ErrorKind::missing, fmt::format("--require {}: {} is {}: {}", row.key.backend,
                                                        row_name(row.key), name_of(status), reason_of(row)));
    }
}

void write_junit(const std::vector<RowRecord>& rows, const CheckJudgement& judgement, const Options& options,
                 const std::string& problem)
{
    if (!options.junit) return;
    std::string xml = junit_xml(rows, judgement, problem, name_of(options.verb));
    if (options.anonymous) xml = anonymous_text(xml, options);
    if (prints_junit(options))
        print(xml);
    else
        write_whole(*options.junit, xml);
}

void deliver_besides_junit(const Options& options, const Report& report)
{
    if (!prints_junit(options))
        deliver(options, report);
    else if (options.out)
        deliver_to_file(options, report);
}

int with_junit(const std::vector<RowRecord>& rows, const CheckJudgement& judgement, const Options& options,
               const std::function<int()>& work)
{
    if (options.junit && !prints_junit(options)) check_writable("--junit", *options.junit);
    int code = 0;
    try {
        code = work();
    } catch (const Error& error) {
        write_junit(rows, judgement, options, error.what());
        throw;
    }
    const bool interrupted = code == exit_code(ErrorKind::interrupted);
    write_junit(rows, judgement, options,
                interrupted ? fmt::format("the {} was interrupted: not all views were traced", name_of(options.verb))
                            : "");
    return code;
}

namespace {

/// What does not go together.
void require_whole_rows(const Options& options)
{
    const auto reject = [](const char* what) { throw Error(ErrorKind::usage, what); };
    const bool is_shard = !shard_of(options).is_whole();
    if (options.resume && options.picture_folder)
        reject("--resume: --differences would lack the pictures of views that were traced before; "
               "leave one of them out");
    const bool has_no_rows = !has_rows(options);
    if (options.variants > 0 && (options.defects || options.stress))
        reject("--variants changes the kernels of rows, and --defects and --stress run others; leave one of them out");
    if (options.variants > 0 && (!options.expected.empty() || options.write_expected || is_shard))
        reject("--variants has no expectations and no shards; leave out --expect, --write-expect and --shard");
    if (has_no_rows && (options.resume || options.picture_folder || options.array_folder || options.allow_flawed))
        reject("--defects, --stress and --variants run other kernels than those of rows; leave out --resume, "
               "--differences, --out-arrays and --allow-flawed");
    if (options.repeat > 1 && has_no_rows)
        reject("--repeat repeats rows, and --defects, --stress and --variants have none; leave one of them out");
    if (options.repeat > 1 && is_shard) reject("--repeat: shards have no repetitions; leave out --shard");
    if (is_shard && (!options.expected.empty() || options.write_expected))
        reject("--expect and --write-expect are about whole rows, and a shard has some of their views; leave out "
               "--shard");
}

} // namespace

int check_command(const Options& asked)
{
    const Options options = with_default_layouts(asked);
    if (options.list) return list_selected(options);
    require_whole_rows(options);
    if (options.defects || options.stress) return check_defects(options);
    if (options.variants > 0) return check_variants(options);
    check_output(options);
    const StopWhenInterrupted stop;
    if (options.junit || options.out) something_to_keep(); // also where a CI's time ends before the first view
    Checked checked;
    if (!options.expected.empty()) checked.expectations = read_expectations(options.expected);
    if (options.write_expected) checked.target.emplace(*options.write_expected);
    return with_junit(checked.rows, checked.judgement, options, [&] { return check(options, checked); });
}

} // namespace tetrace
