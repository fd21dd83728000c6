#pragma once

#include "bench/expectations/judgement.h"
#include "bench/options/benchmark_flags.h"
#include "bench/options/options.h"
#include "bench/output/bench_report.h"

#include <functional>
#include <string>
#include <vector>

namespace tetrace {

// One function for each verb. Returns the exit code; throws Error where the verb ends early.
int devices_command(const Options& options);
int scenes_command(const Options& options);
int build_command(const Options& options);
int bench_command(const Options& options);
int check_command(const Options& options);
int render_command(const Options& options);
int reproduce_command(const Options& options);
int inspect_command(const Options& options);
int trace_command(const Options& options);
int dump_command(const Options& options);
int rays_command(const Options& options);
int judge_command(const Options& options);
int compare_command(const Options& options);
int show_command(const Options& options);
int report_command(const Options& options);
int page_command(const Options& options);
int merge_command(const Options& options);

/// Opens, verifies and times the rows of `bench`, or of another run like it, and measures their devices.
/// journal: goes on with what it has, and keeps the run's views and samples; may be null. image_seen: called after each
/// verified image. Throws as open_and_verify() and measure_rows() do.
[[nodiscard]] BenchResult run_bench(const std::vector<RowKey>& keys, const Options& options,
                                    const BenchmarkFlags& flags, Journal* journal, const ImageSeen& image_seen = {});

/// Adds what follows from the rows and from the options: devices, which are measured, and comparisons. result: with
/// all its rows, scenes and samples.
void complete(BenchResult& result, const Options& options);

/// Throws Error{missing} naming the first row of a required backend that has not been judged, unless that is expected:
/// all its rows were selected, but none ran. judgement: of these rows.
void require_judged(const std::vector<RowRecord>& rows, const CheckJudgement& judgement,
                    const std::vector<std::string>& backends);

/// `check --defects` and `check --stress`. options: with the default layouts of check.
int check_defects(const Options& options);
/// `check --variants`, as check_defects().
int check_variants(const Options& options);

/// Throws Error{missing} naming the first backend of the list without a usable device, with the reason.
void require_devices(const std::vector<std::string>& backends);

/// From here on an interrupt says that the journal has what is finished, and the command line that goes on with it.
void say_how_to_go_on(const Options& options);
/// Says so, if it was asked for, at the end of a run that was interrupted; the exit code.
[[nodiscard]] int end_interrupted();
/// The same after a result of what ran by then has been written: names its file.
[[nodiscard]] int end_interrupted_with_result(const Options& options);

/// Throws Error{missing} naming the first required backend of which no row is selected, so that it would pass
/// unnoticed.
void require_selected(const std::vector<RowKey>& keys, const Options& options);

/// Whether --junit is for standard output.
[[nodiscard]] bool prints_junit(const Options& options);
/// Writes the file of --junit where it was asked for. judgement: of these rows. problem: why the run ended early, or
/// fails although no row does; empty where neither is so.
void write_junit(const std::vector<RowRecord>& rows, const CheckJudgement& judgement, const Options& options,
                 const std::string& problem = {});
/// Delivers a report, but not to standard output if that is for --junit.
void deliver_besides_junit(const Options& options, const Report& report);
/// Does a verb's work, whose exit code it returns, and writes the file of --junit, also if the work ends early: whoever
/// reads only the XML must not take a run without a result for a good one. rows, judgement: filled by the work.
int with_junit(const std::vector<RowRecord>& rows, const CheckJudgement& judgement, const Options& options,
               const std::function<int()>& work);

/// What a long run says where it is interrupted and keeps nothing: how to begin again. Empty for a short one.
[[nodiscard]] std::string words_when_begun(const Options& options);

/// Runs the program on a command line without its name; prints errors; returns the exit code.
int run_program(const std::vector<std::string>& arguments);

} // namespace tetrace
