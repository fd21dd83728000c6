#include "bench/measuring/measure.h"

#include "bench/measuring/reporters.h"
#include "bench/measuring/sampling/sampler.h"
#include "bench/rows/physical_device.h"
#include "bench/rows/row_tracing.h"
#include "bench/terminal/colour.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "core/base/whole_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <iostream>
#include <map>
#include <numeric>
#include <sstream>
#include <unistd.h>

namespace tetrace {

namespace {

/// The same counters for every row: otherwise Google Benchmark's CSV ends the program. Steps are in our own section. No
/// counter that is a rate by its flags: of these the console shows "/s" once more.
void set_counters(benchmark::State& state, const RowRun& row)
{
    state.counters["Mrays/s"] = 1e-6 * static_cast<double>(traced(row)->totals.rays) / row.samples_s.back();
}

/// Counts the repetitions of all rows, for the progress line.
struct Sweep {
    const Budget* budget; ///< whose clock is read
    Pulses* pulses;
    const Sampler* sampler;
    unsigned samples; ///< per row and run
    unsigned run = 0;
    double done = 0, all = 1;
};

/// Seconds of a pass over all views.
struct Pass {
    double kernel_s = 0, wall_s = 0, download_s = 0;
};

/// What else happens in a pass.
struct Besides {
    std::function<void(double)> tell_progress;
    std::function<void(const ViewBatch&, std::span<const Hit>)> see = {}; ///< given each launch's hits
    std::function<void()> in_last_launch = {};                            ///< called during the last launch
};

/// batches: a launch for each. passes: of each batch; the seconds are those of all of them.
Pass trace_batches(RowRun& row, const std::vector<ViewBatch>& batches, std::uint32_t passes, const Budget& budget,
                   const Besides& besides)
{
    Pass pass;
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < batches.size(); ++i) {
        // Not inside a timed interval: a sample may take minutes, and drawing adds nothing to a row's time.
        besides.tell_progress(static_cast<double>(i) / static_cast<double>(batches.size()));
        std::vector<TraceJob> jobs = prepare_batch(row, batches[i]);
        for (TraceJob& job : jobs)
            job.passes = passes;
        const bool is_last = i + 1 == batches.size();
        const auto [kernel_s, wall_s] = timed_launch(*row.session, jobs, budget.clock(),
                                                     is_last ? besides.in_last_launch : std::function<void()>());
        pass.kernel_s += kernel_s;
        pass.wall_s += wall_s;
        if (!besides.see) continue;
        hits.assign(ray_count(row, batches[i]), Hit{POISON, POISON, 0, 0, 0, 0});
        row.session->read_back(hits);
        pass.download_s += row.session->download_s();
        besides.see(batches[i], hits);
    }
    return pass;
}

/// A device that answers differently under repetition, or to jobs in flight together, must lose its rate.
void check_hits(const RowRun& row, const ViewBatch& views, std::span<const Hit> hits)
{
    for (const std::size_t view : views) {
        const auto of_view = hits.first(ray_count(row, view));
        hits = hits.subspan(of_view.size());
        if (hash_of(of_view) != traced(row)->view_hashes.at(view))
            throw Error(ErrorKind::internal, fmt::format("the hits of view {} changed between verifying and measuring",
                                                         row.scene->view_numbers()[view]));
    }
}

/// Joins the views of each timed row for the launches of its samples. Rows keep their outputs in the memory that they
/// share.
void join_views_of(std::vector<RowRun>& rows)
{
    std::vector<Device> devices;
    for (const RowRun& row : rows)
        devices.push_back(row.device);
    const auto hardware = physical_devices(devices);
    std::map<std::size_t, std::size_t> timed;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (is_timed(rows[i])) ++timed[hardware[i]];
    for (std::size_t i = 0; i < rows.size(); ++i) {
        RowRun& row = rows[i];
        if (!is_timed(row)) continue;
        row.batches = joined_views(row, batch_limit(row, timed[hardware[i]]));
        row.launches = {static_cast<std::uint32_t>(row.batches.size()),
                        static_cast<std::uint32_t>(single_views(row).size())};
    }
}

/// Verification has already paid the costs of a row's first passes: compiling at the first launch, finding the launch
/// size, touching memory. One more pass just before the samples wakes the device up, shows what a sample costs, and
/// times the download. A GPU gets a joined one too, which finds the size of joined launches.
void warm_up(RowRun& row, const Sampler& sampler, Budget& budget, const std::function<void(double)>& tell_progress)
{
    guarded(row, [&] {
        const auto ignore = [](const ViewBatch&, std::span<const Hit>) {};
        Pass pass = trace_batches(row, single_views(row), 1, budget, {tell_progress, ignore});
        std::get<Traced>(row.outcome).download_s = pass.download_s;
        budget.traced(row, row.scene->views().size(), pass.wall_s);
        if (!runs_on_host(row.device)) pass = trace_batches(row, row.batches, 1, budget, {tell_progress});
        sampler.warmed_up(row, pass.kernel_s);
        row.warm_s = pass.wall_s + (row.passes > 1 ? row.passes * pass.kernel_s : 0);
    });
}

/// Expected seconds of the timed part.
struct TimedPart {
    double sweep_s = 0;   ///< one sample of every row
    double latency_s = 0; ///< the passes with a launch for each view
};

TimedPart warm_up_rows(std::vector<RowRun>& rows, unsigned samples, const Sampler& sampler, Budget& budget)
{
    double done = 0;
    for (RowRun& row : rows) {
        if (is_interrupted()) break;
        budget.review_timed();
        const auto tell = [&](double part) {
            progress_line().show("warming up", (done + part) / static_cast<double>(rows.size()), -1,
                                 row.key.scene + ", " + row_label(row.key));
        };
        if (is_timed(row)) warm_up(row, sampler, budget, tell);
        done += 1;
    }
    budget.review_timed();
    TimedPart part;
    for (const RowRun& row : rows) {
        if (!is_timed(row)) continue;
        part.sweep_s += row.warm_s;
        if (row.launches.joined < row.launches.single)
            part.latency_s += latency_passes(samples, row.passes) * row.warm_s / (row.passes > 1 ? row.passes + 1 : 1);
    }
    return part;
}

/// Seconds of a pass.
double take_sample(RowRun& row, const Sweep& sweep)
{
    sweep.pulses->take_if_due();
    const auto tell = [&](double done) {
        progress_line().show("measuring", (sweep.done + done) / sweep.all, -1,
                             row.key.scene + ", " + row_label(row.key));
    };
    Besides besides{tell};
    const std::size_t taken = row.samples_s.size() - sweep.run * sweep.samples;
    if (taken + 1 == sweep.samples) // the last one
        besides.see = [&](const ViewBatch& views, std::span<const Hit> hits) { check_hits(row, views, hits); };
    const auto trace = [&](std::uint32_t passes, const std::function<void()>& meanwhile) {
        besides.in_last_launch = meanwhile;
        const Pass pass = trace_batches(row, row.batches, passes, *sweep.budget, besides);
        return LaunchTimes{pass.kernel_s, pass.wall_s};
    };
    const Sample sample = sweep.sampler->take(row, trace);
    sweep.pulses->sampled(row, sample.begin_s, sample.end_s);
    row.wall_samples_s.push_back(sample.pass.wall_s);
    const bool has_latency = row.launches.joined == row.launches.single; // its samples have a launch for each view
    if (!has_latency && taken < latency_passes(sweep.samples, row.passes))
        row.latency_samples_s.push_back(trace_batches(row, single_views(row), 1, *sweep.budget, {tell}).kernel_s);
    return sample.pass.kernel_s;
}

void run_row(benchmark::State& state, RowRun& row, Sweep& sweep)
{
    for ([[maybe_unused]] const auto iteration : state) {
        if (is_interrupted()) {
            state.SkipWithError("interrupted");
            return;
        }
        double seconds = 0;
        if (traced(row) != nullptr) guarded(row, [&] { seconds = take_sample(row, sweep); });
        if (traced(row) == nullptr) {
            state.SkipWithError(reason_of(row).c_str());
            return;
        }
        state.SetIterationTime(seconds);
        // Recorded here: reporters see only aggregates if Google Benchmark is asked for them.
        row.samples_s.push_back(seconds);
        sweep.done += 1;
    }
    set_counters(state, row);
}

void register_rows(const std::vector<RowRun*>& rows, unsigned samples, Sweep& sweep)
{
    benchmark::ClearRegisteredBenchmarks();
    for (RowRun* const row : rows)
        benchmark::RegisterBenchmark(row_name(row->key).c_str(),
                                     [row, &sweep](benchmark::State& state) { run_row(state, *row, sweep); })
            ->Iterations(1)
            ->Repetitions(static_cast<int>(samples))
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
}

/// As Google Benchmark chooses them, but that NO_COLOR is honoured.
benchmark::ConsoleReporter::OutputOptions console_options(const BenchmarkFlags& flags)
{
    using Console = benchmark::ConsoleReporter;
    const int colour = flags.colour.value_or(has_colour(STDOUT_FILENO)) ? Console::OO_Color : Console::OO_None;
    return static_cast<Console::OutputOptions>(colour | (flags.tabular ? Console::OO_Tabular : Console::OO_None));
}

std::unique_ptr<RowReporter> make_display(const BenchmarkFlags& flags, std::size_t runs)
{
    std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers;
    if (flags.format) receivers.push_back(make_reporter(*flags.format, std::cout, console_options(flags)));
    return std::make_unique<RowReporter>(std::move(receivers), runs);
}

/// Keeps what is to be written to the file of --benchmark_out. Google Benchmark gives the stream of that option only
/// to the file reporter; read_benchmark_flags() lets it lead nowhere.
class FileReporter : public RowReporter {
public:
    FileReporter(const std::string& format, std::size_t runs)
        : FileReporter(format, runs, std::make_unique<std::ostringstream>())
    {
    }
    [[nodiscard]] std::string text() const { return text_->str(); }

private:
    FileReporter(const std::string& format, std::size_t runs, std::unique_ptr<std::ostringstream> text)
        : RowReporter(one(make_reporter(format, *text)), runs), text_(std::move(text))
    {
    }
    static std::vector<std::unique_ptr<benchmark::BenchmarkReporter>>
    one(std::unique_ptr<benchmark::BenchmarkReporter> reporter)
    {
        std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> list;
        list.push_back(std::move(reporter));
        return list;
    }

    std::unique_ptr<std::ostringstream> text_;
};

/// Google Benchmark looks at no stream's state.
void require_printed(const BenchmarkFlags& flags)
{
    std::cout.flush();
    if (flags.format && !std::cout)
        throw Error(ErrorKind::invalid_input, "writing the output of --benchmark_format to standard output failed; "
                                              "check that the disk is not full, or use --benchmark_out FILE");
}

/// All are closed before the first is opened again.
void reopen_rows(std::vector<RowRun>& rows, const Options& options)
{
    std::vector<RowRun*> timed;
    for (RowRun& row : rows)
        if (is_timed(row)) timed.push_back(&row);
    for (RowRun* const row : timed)
        row->session.reset();
    for (const RowRun* const row : timed)
        row->backend->restart();
    for (std::size_t i = 0; i < timed.size(); ++i) {
        progress_line().show("opening again", static_cast<double>(i) / static_cast<double>(timed.size()), -1,
                             row_label(timed[i]->key));
        reopen_row(*timed[i], options);
    }
}

/// Of the run that has just been measured.
void count_samples(RowRun& row)
{
    row.run_samples.push_back(row.samples_s.size() -
                              std::accumulate(row.run_samples.begin(), row.run_samples.end(), std::size_t{0}));
}

void check_rows_after(std::vector<RowRun>& rows)
{
    if (is_interrupted()) return;
    for (RowRun& row : rows)
        if (is_timed(row))
            guarded(row, [&] {
                if (row.samples_s.empty()) throw Error(ErrorKind::internal, "Google Benchmark took no sample of it");
            });
}

} // namespace

unsigned affordable_samples(unsigned asked, double sweep_s, double left_s)
{
    if (sweep_s * asked <= left_s) return asked;
    const auto fitting = static_cast<unsigned>(std::max(0.0, left_s / sweep_s));
    return std::clamp(fitting, std::min(asked, min_samples), asked);
}

Measurement measure_rows(std::vector<RowRun>& rows, const Options& options, const BenchmarkFlags& flags, Budget& budget,
                         const Pulses::Work& host, const FindMonitor& find_monitor)
{
    Measurement result;
    const LoadMeter meter;
    Monitors monitors(find_monitor);
    const Sampler sampler(options.sample_s, budget, &monitors);
    join_views_of(rows);
    result.runs = options.runs;
    const TimedPart part = warm_up_rows(rows, options.samples, sampler, budget);
    if (is_interrupted()) return result;
    const double for_samples_s = budget.left_s() - result.runs * part.latency_s - (result.runs - 1) * part.sweep_s;
    result.samples =
        flags.repetitions.value_or(affordable_samples(options.samples, result.runs * part.sweep_s, for_samples_s));
    result.lowered = !flags.repetitions && result.samples < options.samples;
    const auto timed = std::ranges::count_if(rows, is_timed);
    if (timed == 0) return result;
    const auto groups = sample_groups(rows);
    const Stopwatch watch;
    Pulses pulses(rows, host ? host : host_pulse(resolved_threads(options)), budget.clock());
    Sweep sweep{&budget, &pulses, &sampler, result.samples};
    sweep.all = static_cast<double>(timed) * result.samples * result.runs;
    for (const RowRun& row : rows)
        if (is_timed(row)) (void)monitors.of(row); // starting one takes a second: not while a GPU waits for its sample
    const std::size_t reports = groups.size() * result.runs;
    const auto display = make_display(flags, reports);
    const auto file = flags.out.empty() ? nullptr : std::make_unique<FileReporter>(flags.out_format, reports);
    pulses.take();
    for (; sweep.run < result.runs && !is_interrupted(); ++sweep.run) {
        if (sweep.run > 0) {
            reopen_rows(rows, options);
            static_cast<void>(warm_up_rows(rows, options.samples, sampler, budget));
        }
        for (const auto& group : groups) {
            register_rows(group, result.samples, sweep);
            // The filter was applied to the rows themselves, under the reported names.
            benchmark::RunSpecifiedBenchmarks(display.get(), file.get(), "all");
        }
        for (RowRun& row : rows)
            if (is_timed(row)) count_samples(row);
    }
    pulses.take();
    result.load = meter.load();
    result.pulses = pulses.found();
    pulses.judge_rows(rows, result.load);
    progress_line().clear();
    require_printed(flags);
    if (file != nullptr) write_whole(flags.out, file->text());
    check_rows_after(rows);
    result.wall_s = watch.seconds();
    return result;
}

} // namespace tetrace
