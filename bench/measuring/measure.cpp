#include "bench/measuring/measure.h"

#include "bench/measuring/figures.h"
#include "bench/measuring/reporters.h"
#include "bench/rows/json_numbers.h"
#include "bench/rows/physical_device.h"
#include "bench/rows/row_tracing.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/truth/tally.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace tetrace {

namespace {

/// The same counters for every row: otherwise Google Benchmark's CSV ends the program. Steps are in our own section. No
/// counter that is a rate by its flags: of these the console shows "/s" once more.
void set_counters(benchmark::State& state, const RowRun& row)
{
    state.counters["Mrays/s"] = 1e-6 * static_cast<double>(traced(row)->totals.rays) / row.samples_s.back();
}

/// What launches of a row have answered: to the views of a batch, in an output of the row's launches in flight.
struct Answers {
    const ViewBatch* views;
    std::size_t output;
    std::span<const Hit> hits;
};
using SeeAnswers = std::function<void(const Answers&)>;

/// The launches of a row that trace these batches of views, one after the other. Their answers are given to `see`,
/// which may be empty.
Pass pass_of(RowRun& row, const std::vector<ViewBatch>& batches, SeeAnswers see = {})
{
    Pass pass{&row, batches.size(), [&](std::size_t launch) { return prepare_batch(row, batches[launch]); }};
    if (see)
        pass.after = [&row, &batches, see = std::move(see)](std::size_t launch, std::size_t outputs) {
            const std::size_t rays = ray_count(row, batches[launch]);
            std::vector<Hit> hits(outputs * rays, Hit{POISON, POISON, 0, 0, 0, 0});
            row.session->read_back(hits);
            for (std::size_t output = 0; output < outputs; ++output)
                see({&batches[launch], output, std::span(hits).subspan(output * rays, rays)});
        };
    return pass;
}

/// The launches of the row's samples.
Pass sample_pass(RowRun& row, SeeAnswers see = {})
{
    Pass pass = pass_of(row, row.batches, std::move(see));
    pass.in_flight = row.key.in_flight;
    return pass;
}

/// A device that answers differently under repetition, or to jobs and launches in flight together, must lose its rate.
void check_hits(const RowRun& row, const Answers& answers)
{
    std::span<const Hit> hits = answers.hits;
    if (traits_of(row.key.kernel.task).tallies) require_total(row.session->tally(), hits);
    for (const std::size_t view : *answers.views) {
        const auto of_view = hits.first(ray_count(row, view));
        hits = hits.subspan(of_view.size());
        if (hash_of(of_view) == traced(row)->view_hashes.at(view)) continue;
        const std::string output = row.key.in_flight == 1 ? std::string()
                                                          : fmt::format(" in output {} of {} launches in flight",
                                                                        answers.output + 1, row.key.in_flight);
        throw Error(ErrorKind::internal, fmt::format("the hits of view {}{} changed between verifying and measuring",
                                                     row.scene->view_numbers()[view], output));
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
        row.batches = joined_views(row, batch_limit(row, timed[hardware[i]]) / row.key.in_flight);
        row.launches = {static_cast<std::uint32_t>(row.batches.size()),
                        static_cast<std::uint32_t>(single_views(row).size())};
    }
}

/// Verification has already paid the costs of a row's first passes: compiling at the first launch, finding the launch
/// size, touching memory. One more pass just before the samples wakes the device up, shows what a sample costs, and
/// times the download. A GPU gets a joined one too, which finds the size of joined launches. Launches in flight
/// together have not been verified yet.
void warm_up(RowRun& row, const Sampler& sampler, Budget& budget, const std::function<void(double)>& tell_progress)
{
    guarded(row, [&] {
        const std::vector<ViewBatch> views = single_views(row);
        double download_s = 0;
        Pass pass = pass_of(row, views, [&](const Answers&) { download_s += row.session->download_s(); });
        pass.tell_progress = tell_progress;
        LaunchTimes times = run_pass(pass, 1, budget.clock());
        std::get<Traced>(row.outcome).download_s = download_s;
        budget.traced(row, row.scene->views().size(), times.wall_s);
        if (!runs_on_host(row.device)) times = run_pass(sample_pass(row), 1, budget.clock());
        if (row.key.in_flight > 1) {
            const auto check = [&](const Answers& answers) { check_hits(row, answers); };
            times = run_pass(sample_pass(row, check), row.key.in_flight, budget.clock());
            times.kernel_s /= row.key.in_flight;
            times.wall_s /= row.key.in_flight;
        }
        sampler.warmed_up(row, times.kernel_s);
        row.warm_s = times.wall_s + (row.passes > 1 ? row.passes * times.kernel_s : 0);
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
        if (!has_latency(row))
            part.latency_s += latency_passes(samples, row.passes) * row.warm_s / (row.passes > 1 ? row.passes + 1 : 1);
    }
    return part;
}

/// Where samples are kept until the next line of the journal, which has those of some seconds: its writing waits for
/// the disk.
class SampleLog {
public:
    SampleLog(Journal* journal, MachineWatch& watch, std::vector<RowRun>& rows, unsigned samples)
        : journal_(journal), watch_(&watch), rows_(&rows), samples_(samples)
    {
    }

    void begin_run(unsigned run)
    {
        if (!pending_.empty()) write(false);
        run_ = run;
    }
    void add(const RowRun& row, const RowSamples& sample)
    {
        if (journal_ == nullptr) return;
        append_samples(pending_[row_name(row.key)], sample);
        if (watch_->now() - written_s_ >= every_s) write(false);
    }
    /// is_last: of the run: the load is read, however short it was.
    void write(bool is_last)
    {
        nlohmann::json readings = watch_->new_readings(is_last);
        if (journal_ == nullptr) return;
        nlohmann::json entry = {{samples_key, {{"run", run_}, {"of", samples_}}}, {"rows", nlohmann::json::object()}};
        for (const auto& [name, samples] : pending_)
            entry["rows"][name] = samples_json(samples);
        for (const RowRun& row : *rows_)
            if (traced(row) == nullptr && told_.insert(&row).second)
                entry[ended_key][row_name(row.key)] = ended_json(row.outcome);
        if (!readings.is_null()) entry[MachineWatch::entry_key] = std::move(readings);
        journal_->append(entry);
        pending_.clear();
        written_s_ = watch_->now();
    }

    static constexpr const char *samples_key = "samples", *ended_key = "ended";

private:
    static constexpr double every_s = 2;

    Journal* journal_;
    MachineWatch* watch_;
    std::vector<RowRun>* rows_;
    unsigned samples_, run_ = 0;
    std::map<std::string, RowSamples> pending_;
    std::set<const RowRun*> told_; ///< rows that have ended: a run that goes on does not take them up again
    double written_s_ = 0;
};

constexpr unsigned max_rounds = 3; // of samples of a row that stays noisy

/// Counts the samples of all rows, for the progress line, and what is needed to take one.
struct Sweep {
    const Budget* budget; ///< whose clock is read
    const Sampler* sampler;
    SampleLog* log;
    unsigned samples; ///< per row and run
    double done = 0, all = 1;
    std::map<const RowRun*, unsigned> targets = {}; ///< of rows that are sampled on
    std::exception_ptr failure = {};                ///< of the journal: Google Benchmark lets none through

    /// Samples of a row in the current run.
    [[nodiscard]] unsigned target(const RowRun& row) const
    {
        const auto found = targets.find(&row);
        return found == targets.end() ? samples : found->second;
    }
};

/// Of the current run.
std::size_t samples_in_run(const RowRun& row)
{
    return row.samples_s.size() - std::accumulate(row.run_samples.begin(), row.run_samples.end(), std::size_t{0});
}

RowSamples take_sample(RowRun& row, const Sweep& sweep)
{
    const auto tell = [&](double done) {
        progress_line().show("measuring", (sweep.done + done) / sweep.all, -1,
                             row.key.scene + ", " + row_label(row.key));
    };
    const std::size_t taken = samples_in_run(row);
    Pass pass = taken + 1 < sweep.target(row)
                    ? sample_pass(row)
                    : sample_pass(row, [&](const Answers& answers) { check_hits(row, answers); });
    pass.tell_progress = tell;
    RowSamples sample;
    sweep.sampler->take(pass, sample);
    if (!has_latency(row) && taken < latency_passes(sweep.samples, row.passes)) {
        const std::vector<ViewBatch> views = single_views(row);
        Pass alone = pass_of(row, views);
        alone.tell_progress = tell;
        sample.latency_samples_s.push_back(run_pass(alone, 1, sweep.budget->clock()).kernel_s);
    }
    add_samples(row, sample);
    return sample;
}

/// A journal that cannot be written ends the run, not the row.
void keep_sample(const RowRun& row, const RowSamples& sample, Sweep& sweep)
{
    try {
        sweep.log->add(row, sample);
    } catch (const Error&) {
        sweep.failure = std::current_exception();
    }
}

void run_row(benchmark::State& state, RowRun& row, Sweep& sweep)
{
    for ([[maybe_unused]] const auto iteration : state) {
        if (is_interrupted() || sweep.failure) {
            state.SkipWithError("interrupted");
            return;
        }
        std::optional<RowSamples> sample;
        if (traced(row) != nullptr) guarded(row, [&] { sample = take_sample(row, sweep); });
        if (sample) keep_sample(row, *sample, sweep);
        if (traced(row) == nullptr) {
            state.SkipWithError(reason_of(row).c_str());
            return;
        }
        state.SetIterationTime(row.samples_s.back());
        sweep.done += 1;
    }
    set_counters(state, row);
}

/// Those that lack samples of the current run; whether there are any.
bool register_rows(const std::vector<RowRun*>& rows, Sweep& sweep)
{
    benchmark::ClearRegisteredBenchmarks();
    bool is_any = false;
    for (RowRun* const row : rows) {
        const std::size_t taken = samples_in_run(*row);
        const unsigned target = sweep.target(*row);
        if (taken >= target) continue;
        is_any = true;
        benchmark::RegisterBenchmark(row_name(row->key).c_str(),
                                     [row, &sweep](benchmark::State& state) { run_row(state, *row, sweep); })
            ->Iterations(1)
            ->Repetitions(static_cast<int>(target - taken))
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    }
    return is_any;
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

/// Rows that are noisy so far.
std::vector<RowRun*> noisy_rows(std::vector<RowRun>& rows)
{
    std::vector<RowRun*> noisy;
    for (RowRun& row : rows)
        if (const auto figures = figures_of(row); is_timed(row) && figures && figures->noisy) noisy.push_back(&row);
    return noisy;
}

/// Takes further samples of noisy rows: what disturbed them may have passed.
void sample_on(std::vector<RowRun>& rows, Sweep& sweep, MachineWatch& watch, const Budget& budget,
               GoogleReports& google)
{
    const unsigned most = max_rounds * sweep.samples;
    while (!is_interrupted() && !sweep.failure) {
        watch.pulses().take();
        sweep.log->write(true);
        watch.pulses().judge_rows(rows, watch.load());
        std::vector<RowRun*> noisy = noisy_rows(rows);
        std::erase_if(noisy, [&](const RowRun* row) { return samples_in_run(*row) >= most; });
        double sample_s = 0;
        for (const RowRun* const row : noisy)
            sample_s += row->warm_s;
        if (noisy.empty() || budget.left_s() < sample_s) return;
        const double fitting = sample_s > 0 ? budget.left_s() / sample_s : sweep.samples;
        for (const RowRun* const row : noisy) {
            const auto taken = static_cast<unsigned>(samples_in_run(*row));
            sweep.targets[row] =
                std::min(most, taken + static_cast<unsigned>(std::min<double>(sweep.samples, fitting)));
            sweep.all += sweep.targets[row] - taken;
        }
        for (const auto& group : sample_groups(noisy))
            if (register_rows(group, sweep)) google.run();
    }
}

/// At the end of a run, in which an interrupted one may have taken none.
void count_samples(std::vector<RowRun>& rows)
{
    for (RowRun& row : rows)
        if (const std::size_t taken = samples_in_run(row); is_timed(row) && taken > 0) row.run_samples.push_back(taken);
}

/// What the journal of an earlier process of the run has.
struct EarlierSamples {
    unsigned run = 0;     ///< that it was in
    unsigned samples = 0; ///< of each row in each run; 0: it took none
    std::vector<std::pair<const RowRun*, std::pair<double, double>>> taken; ///< when each sample was, for the pulses
};

/// most: of a run.
void restore_row(RowRun& row, const RowSamples& samples, unsigned most)
{
    require_samples(samples, samples.samples_s.size(), true);
    add_samples(row, samples);
    if (samples_in_run(row) > most)
        throw std::domain_error(fmt::format("{} has more than {} samples of a run", row_name(row.key), most));
}

/// rounds: how many times the samples of a run a row may have.
EarlierSamples restore_samples(std::vector<RowRun>& rows, const Journal& journal, unsigned rounds)
{
    EarlierSamples earlier;
    try {
        for (const nlohmann::json& entry : journal.entries()) {
            if (!entry.contains(SampleLog::samples_key)) continue;
            const nlohmann::json& which = entry[SampleLog::samples_key];
            earlier.samples = count_from<unsigned>(which.at("of"));
            for (const auto run = count_from<unsigned>(which.at("run")); earlier.run < run; ++earlier.run)
                count_samples(rows);
            const nlohmann::json none = nlohmann::json::object(), &samples = entry.at("rows"),
                                 &ended = entry.contains(SampleLog::ended_key) ? entry[SampleLog::ended_key] : none;
            for (RowRun& row : rows) {
                const std::string name = row_name(row.key);
                if (is_timed(row) && samples.contains(name)) {
                    const RowSamples more = samples_from(samples[name]);
                    restore_row(row, more, rounds * earlier.samples);
                    for (const auto& interval : more.sampled_s)
                        earlier.taken.emplace_back(&row, interval);
                }
                if (traced(row) != nullptr && ended.contains(name)) {
                    row.outcome = ended_from(ended[name]);
                    row.session.reset();
                }
            }
        }
    } catch (const nlohmann::json::exception& error) {
        journal.reject(fmt::format("samples in the journal are damaged: {}", error.what()));
    } catch (const std::logic_error& error) {
        journal.reject(fmt::format("samples in the journal are damaged: {}", error.what()));
    }
    return earlier;
}

/// A rate has an interval, or the row has none.
void drop_few_samples(std::vector<RowRun>& rows, unsigned asked)
{
    for (RowRun& row : rows)
        if (row.samples_s.size() < std::min<std::size_t>(min_samples, asked)) {
            row.samples_s.clear();
            row.wall_samples_s.clear();
            row.latency_samples_s.clear();
            row.run_samples.clear();
            row.readings.reset();
            row.pulse_ratio.reset();
            row.disturbance.clear();
        }
}

void check_rows_after(std::vector<RowRun>& rows)
{
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
    MachineWatch watch(host ? host : host_pulse(resolved_threads(options)), {}, budget.clock(), 0, find_monitor);
    return measure_rows(rows, options, flags, {nullptr, nullptr, &watch, &budget});
}

Measurement measure_rows(std::vector<RowRun>& rows, const Options& options, const BenchmarkFlags& flags,
                         const Recording& shared)
{
    Budget& budget = *shared.budget;
    MachineWatch& watch = *shared.watch;
    Measurement result;
    watch.begin_load();
    const Sampler sampler(options.sample_s, budget, &watch);
    join_views_of(rows);
    result.runs = options.runs;
    EarlierSamples earlier;
    // Google's own reports are of as many samples for each row.
    const bool exact =
        options.exact_samples || options.runs > 1 || flags.repetitions || flags.format || !flags.out.empty();
    if (shared.journal != nullptr) earlier = restore_samples(rows, *shared.journal, exact ? 1 : max_rounds);
    result.samples = earlier.samples;
    const TimedPart part = warm_up_rows(rows, options.samples, sampler, budget);
    if (is_interrupted()) {
        count_samples(rows);
        drop_few_samples(rows, options.samples);
        return result;
    }
    watch.pulses().watch(pointers_to(rows), last_view_pulse(budget.clock()));
    for (const auto& [row, interval] : earlier.taken)
        watch.pulses().sampled(*row, interval.first, interval.second);
    const double for_samples_s = budget.left_s() - result.runs * part.latency_s - (result.runs - 1) * part.sweep_s;
    result.samples = earlier.samples > 0 ? earlier.samples
                                         : flags.repetitions.value_or(affordable_samples(
                                               options.samples, result.runs * part.sweep_s, for_samples_s));
    result.lowered = !flags.repetitions && result.samples < options.samples;
    const auto timed = std::ranges::count_if(rows, [](const RowRun& row) { return is_timed(row); });
    if (timed == 0) return result;
    const auto groups = sample_groups(pointers_to(rows));
    const Stopwatch stopwatch;
    SampleLog log(shared.journal, watch, rows, result.samples);
    Sweep sweep{&budget, &sampler, &log, result.samples};
    sweep.all = static_cast<double>(timed) * result.samples * result.runs;
    for (const RowRun& row : rows)
        sweep.done += static_cast<double>(row.samples_s.size());
    watch.monitors().find(pointers_to(rows));
    const std::size_t reports = groups.size() * result.runs;
    GoogleReports google(flags, reports);
    watch.pulses().take();
    for (unsigned run = earlier.run; run < result.runs && !is_interrupted(); ++run) {
        if (run > earlier.run) {
            reopen_rows(rows, options);
            static_cast<void>(warm_up_rows(rows, options.samples, sampler, budget));
        }
        log.begin_run(run);
        for (const auto& group : groups)
            if (register_rows(group, sweep)) google.run();
        if (!exact) sample_on(rows, sweep, watch, budget, google);
        if (sweep.failure) std::rethrow_exception(sweep.failure);
        count_samples(rows);
    }
    watch.pulses().take();
    log.write(true);
    result.load = watch.load();
    result.pulses = watch.pulses().found();
    watch.pulses().judge_rows(rows, result.load);
    progress_line().clear();
    google.write();
    if (is_interrupted())
        drop_few_samples(rows, result.samples);
    else
        check_rows_after(rows);
    result.wall_s = stopwatch.seconds();
    return result;
}

} // namespace tetrace
