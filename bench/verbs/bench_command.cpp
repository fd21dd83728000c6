#include "bench/measuring/run_journal.h"
#include "bench/measuring/scene_rows.h"
#include "bench/merging/shard_results.h"
#include "bench/output/array_folder.h"
#include "bench/output/bench_report.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

int list_rows(const std::vector<RowKey>& keys)
{
    std::string text;
    for (const RowKey& key : keys)
        text += row_name(key) + "\n";
    print(text);
    return 0;
}

/// Google Benchmark's own JSON always names the host.
void check_anonymous(const Options& options, const BenchmarkFlags& flags)
{
    const bool prints_json = flags.format == "json", writes_json = !flags.out.empty() && flags.out_format == "json";
    if (options.anonymous && (prints_json || writes_json))
        throw Error(ErrorKind::usage,
                    fmt::format("--anonymous: the JSON of {} names the host; --out FILE.json holds the same without it",
                                prints_json ? "--benchmark_format" : "--benchmark_out"));
}

/// A resumed run has samples that Google Benchmark has not seen.
void check_resume(const Options& options, const BenchmarkFlags& flags)
{
    if (options.resume && (flags.format || !flags.out.empty()))
        throw Error(ErrorKind::usage,
                    fmt::format("--resume: {} would lack the samples that were taken before; leave it "
                                "out, --out has all of them",
                                flags.format ? "--benchmark_format" : "--benchmark_out"));
}

} // namespace

BenchResult run_bench(const std::vector<RowKey>& keys, const Options& options, const BenchmarkFlags& flags,
                      Journal* journal, const ImageSeen& image_seen)
{
    if (journal != nullptr) say_how_to_go_on(options);
    BenchResult result;
    result.missing_scenes = missing_default_scenes(options);
    Budget budget = flags.repetitions ? Budget() : Budget(options.budget_s);
    MachineWatch watch = watch_of(host_pulse(resolved_threads(options)), journal);
    const Recording shared{journal, nullptr, &watch, &budget};
    SceneRows run = open_and_verify(keys, options, image_seen, shared);
    result.measurement = measure_rows(run.rows, options, flags, shared);
    result.rows = records_of(run.rows);
    result.scenes = scene_records(run, options);
    complete(result, options);
    return result;
}

void complete(BenchResult& result, const Options& options)
{
    result.conditions = host_conditions();
    result.devices = devices_of(result.rows);
    result.interrupted = is_interrupted();
    if (!result.interrupted) measure_devices(result.devices, session_options(options));
    result.comparisons = compare_rows(result.rows);
    result.best_bvhs = compare_with_best_bvh(result.rows);
    result.missing_devices = missing_devices(options);
    result.threads = resolved_threads(options);
    result.samples_asked = options.samples;
    result.budget_s = options.budget_s;
}

namespace {

/// rows, judgement: what was measured, also if it then throws.
int bench(const Options& options, const BenchmarkFlags& flags, const std::vector<RowKey>& keys,
          std::vector<RowRecord>& rows, CheckJudgement& judgement)
{
    const auto arrays = make_array_folder(options);
    nlohmann::json head = run_head(options, keys);
    if (flags.repetitions) head["repetitions"] = *flags.repetitions;
    const auto journal = open_journal(options, head);
    const BenchResult result = run_bench(keys, options, flags, journal.get(), [&](const SeenImage& image) {
        if (arrays != nullptr) arrays->see(image);
    });
    rows = result.rows;
    judgement = judge_answers(rows);
    Report report = bench_report(result, options, result_head(options));
    if (arrays != nullptr) report.sheet.labelled("Arrays", arrays->path().string());
    if (options.junit && !prints_junit(options)) report.sheet.labelled("JUnit", options.junit->string());
    // Google Benchmark has already written its own format to standard output, if it was asked to.
    if (!flags.format)
        deliver_besides_junit(options, report);
    else if (options.out)
        deliver_to_file(options, report);
    if (result.interrupted) return end_interrupted();
    end_journal(journal.get(), options);
    require_judged(rows, judgement, options.required);
    require_answers(rows, "measured");
    return exit_code(rows, true);
}

/// Standard output has room for one of them.
void check_junit(const Options& options, const BenchmarkFlags& flags)
{
    if (prints_junit(options) && flags.format)
        throw Error(ErrorKind::usage, "--junit -: --benchmark_format writes to standard output, too; name a file");
}

} // namespace

int bench_command(const Options& options)
{
    BenchmarkFlags flags = read_benchmark_flags(options.benchmark_flags);
    // Shards have one command line, and ranks one folder.
    if (!flags.out.empty() && !shard_of(options).is_whole())
        flags.out = shard_file(flags.out, shard_of(options)).string();
    check_anonymous(options, flags);
    check_resume(options, flags);
    check_junit(options, flags);
    const auto select = [&] {
        return selected_rows(options,
                             [&](const std::string& name) { return benchmark_filter_keeps(flags.filter, name); });
    };
    if (options.list || flags.list_tests) return list_rows(select());
    check_output(options);
    const StopWhenInterrupted stop;
    check_columns(options, bench_columns());
    if (!flags.out.empty()) check_writable("--benchmark_out", flags.out);
    std::vector<RowRecord> rows;
    CheckJudgement judgement;
    return with_junit(rows, judgement, options, [&] {
        require_devices(options.required); // first: its reason for an empty selection is better
        const auto keys = select();
        require_selected(keys, options);
        return bench(options, flags, keys, rows, judgement);
    });
}

} // namespace tetrace
