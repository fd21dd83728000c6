#include "bench/reproduce/row_recorder.h"

#include "bench/measuring/sampling/sampler.h"
#include "bench/rows/row_tracing.h"
#include "bench/rows/rows.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace tetrace {

namespace {

using nlohmann::json;

void sum_up(RowRun& row, const std::vector<ImageRecord>& images)
{
    row.passes = 1;
    row.readings.reset(); // the last part's
    if (traced(row) == nullptr || images.empty()) return;
    Traced sum;
    row.samples_s.assign(images.front().samples_s.size(), 0);
    row.wall_samples_s = row.samples_s;
    for (const ImageRecord& image : images) {
        sum.add(image.verdict);
        sum.hit_hash = image.chained_hash; // 0 of merged shards, which chain only their own
        row.passes = std::max(row.passes, image.passes);
        if (image.gpu) {
            if (!row.readings) row.readings.emplace();
            row.readings->add(*image.gpu);
        }
        // A row that turned out wrong was no longer timed; it is without a rate.
        for (std::size_t s = 0; s < std::min(row.samples_s.size(), image.samples_s.size()); ++s) {
            row.samples_s[s] += image.samples_s[s];
            row.wall_samples_s[s] += image.wall_samples_s[s];
        }
    }
    row.outcome = std::move(sum);
}

} // namespace

bool is_whole(const RowRecord& row)
{
    return traced(row) != nullptr && traced(row)->totals.rays > 0;
}

bool is_cdt(const RowRecord& row)
{
    return row.key.kernel.structure == Structure::cdt;
}

void RunProgress::show(const std::string& stage) const
{
    const auto fraction = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1));
    const double left_s =
        here == 0 ? -1 : watch.seconds() / static_cast<double>(here) * static_cast<double>(all - done);
    progress_line().show(stage, fraction, left_s);
}

namespace {

/// By the clock of MachineWatch; 0 if the entry lacks samples.
double last_sample_end(const json& entry)
{
    double end_s = 0;
    if (entry.contains("rows"))
        for (const json& row : entry["rows"])
            if (row.contains("sampled_s"))
                for (const json& sample : row["sampled_s"])
                    end_s = std::max(end_s, sample.at(1).get<double>());
    return end_s;
}

} // namespace

MachineWatch watch_of(Pulses::Work host, const Journal* journal, Clock clock)
{
    std::vector<json> readings;
    double sampled_until_s = 0;
    try {
        if (journal != nullptr)
            for (const json& entry : journal->entries()) {
                if (entry.contains(MachineWatch::entry_key)) readings.push_back(entry[MachineWatch::entry_key]);
                sampled_until_s = std::max(sampled_until_s, last_sample_end(entry));
            }
        return MachineWatch(std::move(host), readings, std::move(clock), sampled_until_s);
    } catch (const json::exception& error) {
        journal->reject(fmt::format("a reading of the machine in the journal is damaged: {}", error.what()));
    } catch (const std::logic_error& error) {
        journal->reject(fmt::format("a reading of the machine in the journal is damaged: {}", error.what()));
    }
}

void RowRecorder::run(std::size_t parts, const std::string& name, Journal* journal, RunProgress& progress,
                      MachineWatch* watch, Budget& budget)
{
    budget_ = &budget;
    journal_ = journal;
    watch_ = samples_ > 0 && !is_merged() ? watch : nullptr;
    if (watch_ != nullptr) watch_rows(name);
    const std::string stage = "reproducing, " + name;
    std::size_t part = journal == nullptr ? 0 : restore_parts();
    progress.done += part;
    if (is_merged() && part < parts) reject_journal(fmt::format("{}: {} parts of {}", stage, part, parts));
    if (part < parts) budget.plan_views(run_->rows, samples_, sample_s_, part);
    for (; part < parts; ++part) {
        progress.show(stage);
        const auto entry = run_part(part, part + 1 == parts);
        if (!entry) break;
        something_to_keep();
        if (journal != nullptr) journal->append(*entry);
        progress.done += 1;
        progress.here += 1;
    }
    if (!is_merged() && part == parts) repeat_first_part();
    for (std::size_t i = 0; i < run_->rows.size(); ++i)
        sum_up(run_->rows[i], run_->images[i]);
    progress_line().clear();
}

void RowRecorder::watch_rows(const std::string& name)
{
    const auto first_job_s = [this](RowRun& row) {
        if (!can_repeat_first_job()) return std::optional<double>();
        return median_launch_s(
            row, [&] { return job_of(row, 0); }, host_clock());
    };
    watch_->pulses().watch(run_->rows, first_job_s, ", " + name);
    for (const RowRun& row : run_->rows)
        if (is_timed(row)) (void)watch_->monitors().of(row); // starting one takes a second: not between samples
}

/// Only where every row is launched before its answers are read again: a GPU's pulse leaves those of the first part.
void RowRecorder::take_pulse_if_due()
{
    if (watch_ != nullptr) watch_->pulses().take_if_due();
}

void RowRecorder::end_before_part(std::size_t part, const std::vector<Outcome>& before)
{
    for (std::size_t i = 0; i < run_->rows.size(); ++i) {
        RowRun& row = run_->rows[i];
        if (traced(row) == nullptr) continue;
        row.outcome = before[i];
        if (part == 0) end_interrupted(row);
    }
    if (part > 0) keep_first_parts(part);
}

/// The journal's entry of the part.
std::optional<json> RowRecorder::run_part(std::size_t part, bool is_last)
{
    const Stopwatch watch;
    std::vector<Outcome> before;
    for (const RowRun& row : run_->rows)
        before.push_back(row.outcome);
    records_.assign(run_->rows.size(), {});
    begun_.clear();
    for (std::size_t i = 0; i < run_->rows.size(); ++i)
        if (run_->rows[i].session != nullptr && !is_interrupted()) {
            begun_.push_back(i);
            guarded(run_->rows[i], [&] {
                records_[i] = examine(i, part);
                budget_->traced(run_->rows[i], 1, records_[i].verdict.wall_s);
                // A row that turns out wrong is not timed.
                std::get<Traced>(run_->rows[i].outcome).add(records_[i].verdict);
            });
        }
    if (samples_ > 0 && !is_interrupted()) time_rows(part);
    if (is_interrupted()) {
        end_before_part(part, before);
        return std::nullopt;
    }
    json entry = head_of(part);
    entry["rows"] = json::object();
    for (const RowRun& row : run_->rows) // those that the budget has skipped: a run that goes on skips them too
        if (const auto* skipped = std::get_if<Skipped>(&row.outcome);
            skipped != nullptr && skipped->status == Status::skipped && row.scene != nullptr)
            entry["rows"][row_name(row.key)] = outcome_json(*skipped);
    for (const std::size_t i : begun_) {
        entry["rows"][row_name(run_->rows[i].key)] = outcome_json(outcome(i));
        if (traced(run_->rows[i]) != nullptr) run_->images[i].push_back(std::move(records_[i]));
    }
    entry["wall_s"] = watch.seconds();
    budget_->view_done();
    if (watch_ != nullptr)
        if (json readings = watch_->new_readings(is_last); !readings.is_null())
            entry[MachineWatch::entry_key] = std::move(readings);
    return entry;
}

void RowRecorder::time_rows(std::size_t part)
{
    const Budget unlimited(std::numeric_limits<double>::infinity(),
                           watch_ != nullptr ? [this] { return watch_->now(); } : host_clock());
    const Sampler sampler(sample_s_, unlimited, watch_ != nullptr ? &watch_->monitors() : nullptr);
    for (const auto& group : sample_groups(run_->rows))
        time_group(group, part, sampler);
    take_pulse_if_due();
}

/// Interleaved, so that drift affects all rows alike. The first launch after another row's warms the caches.
void RowRecorder::time_group(const std::vector<RowRun*>& group, std::size_t part, const Sampler& sampler)
{
    const auto for_timed_rows = [&](const auto& work) {
        for (RowRun* const row : group)
            if (is_timed(*row)) guarded(*row, [&] { work(*row); });
    };
    take_pulse_if_due();
    for_timed_rows([&](RowRun& row) {
        row.readings.reset(); // the part before had its own
        sampler.warmed_up(row, timed_launch(*row.session, job_of(row, part)).kernel_s);
    });
    for (unsigned sample = 0; sample < samples_ && !is_interrupted(); ++sample) {
        take_pulse_if_due();
        for_timed_rows([&](RowRun& row) { take_sample(row, part, sampler); });
    }
    // A device that answers differently under repetition must lose its rate. The next group's pulses change its
    // answers.
    for_timed_rows([&](RowRun& row) {
        if (hash_of_answers(row, part) != record_of(row).verdict.hit_hash)
            throw Error(ErrorKind::wrong_result, "the answers changed while they were timed");
    });
}

void RowRecorder::take_sample(RowRun& row, std::size_t part, const Sampler& sampler)
{
    TraceJob job = job_of(row, part);
    const Sample sample = sampler.take(row, [&](std::uint32_t passes, const std::function<void()>& meanwhile) {
        job.passes = passes;
        return timed_launch(*row.session, job, host_clock(), meanwhile);
    });
    ImageRecord& record = record_of(row);
    record.samples_s.push_back(sample.pass.kernel_s);
    record.wall_samples_s.push_back(sample.pass.wall_s);
    record.passes = row.passes;
    record.gpu = row.readings;
    if (watch_ == nullptr) return;
    record.sampled_s.emplace_back(sample.begin_s, sample.end_s);
    watch_->pulses().sampled(row, sample.begin_s, sample.end_s);
}

ImageOutcome RowRecorder::outcome(std::size_t i) const
{
    const Outcome& end = run_->rows[i].outcome;
    if (const auto* skipped = std::get_if<Skipped>(&end)) return *skipped;
    if (const auto* failed = std::get_if<Failed>(&end)) return *failed;
    return records_[i];
}

/// Takes the parts that the journal has, and returns their number.
std::size_t RowRecorder::restore_parts()
{
    std::size_t part = 0, line = 1; // the head's
    const auto reject = [&](const std::exception& error) {
        reject_journal(fmt::format("line {} of the journal is damaged: {}", line, error.what()));
    };
    for (const json& entry : journal_->entries()) {
        ++line;
        try {
            if (is_ours(entry)) restore(part++, entry);
        } catch (const json::exception& error) {
            reject(error);
        } catch (const std::logic_error& error) {
            reject(error);
        }
    }
    return part;
}

void RowRecorder::restore(std::size_t part, const json& entry)
{
    check_entry(part, entry);
    for (const RowRun& row : run_->rows)
        if (traced(row) != nullptr && !entry.at("rows").contains(row_name(row.key)))
            reject_journal(fmt::format("the journal lacks hits of {}, which could not run then", row_name(row.key)));
    for (std::size_t i = 0; i < run_->rows.size(); ++i)
        if (traced(run_->rows[i]) != nullptr)
            restore(i, part, outcome_from_json(entry["rows"][row_name(run_->rows[i].key)]));
}

void RowRecorder::restore(std::size_t i, std::size_t part, ImageOutcome outcome)
{
    RowRun& row = run_->rows[i];
    if (auto* record = std::get_if<ImageRecord>(&outcome)) {
        std::get<Traced>(row.outcome).add(record->verdict);
        check_record(i, part, *record);
        if (watch_ != nullptr)
            for (const auto& [begin_s, end_s] : record->sampled_s)
                watch_->pulses().sampled(row, begin_s, end_s);
        run_->images[i].push_back(std::move(*record));
        return;
    }
    if (auto* skipped = std::get_if<Skipped>(&outcome)) row.outcome = *skipped;
    if (auto* failed = std::get_if<Failed>(&outcome)) row.outcome = *failed;
    row.session.reset();
}

/// Checks that the record is possible for the row, which already has the part's outcome. Throws std::domain_error.
void RowRecorder::check_record(std::size_t i, std::size_t part, const ImageRecord& record) const
{
    const RowRun& row = run_->rows[i];
    const TraceJob job = job_of(row, part);
    const auto rays = std::uint64_t{job.width} * job.height;
    if (record.verdict.totals.rays != rays)
        throw std::domain_error(
            fmt::format("{} has {} rays, not {}", row_name(row.key), record.verdict.totals.rays, rays));
    const std::size_t samples = has_answers(row) ? samples_ : 0;
    const auto is_time = [](double seconds) { return std::isfinite(seconds) && seconds > 0; };
    const bool is_stripped = is_merged() && record.samples_s.empty() && record.wall_samples_s.empty();
    if (is_stripped) return; // several kinds of machines took them
    for (const auto& times : {record.samples_s, record.wall_samples_s})
        if (times.size() != samples || !std::ranges::all_of(times, is_time))
            throw std::domain_error(fmt::format("{} wants {} samples, all above 0 s", row_name(row.key), samples));
    const auto is_interval = [](const auto& interval) {
        return std::isfinite(interval.second) && 0 <= interval.first && interval.first <= interval.second;
    };
    if (watch_ == nullptr) return; // of a merged journal, or nothing is timed
    if (record.sampled_s.size() != samples || !std::ranges::all_of(record.sampled_s, is_interval))
        throw std::domain_error(fmt::format("{} wants the times of {} samples", row_name(row.key), samples));
    if (record.gpu && record.gpu->states.size() != samples)
        throw std::domain_error(fmt::format("{} wants its GPU's readings of {} samples", row_name(row.key), samples));
}

/// Repeats the first part after everything else that the device was given; after a resume, it is the journal's.
void RowRecorder::repeat_first_part()
{
    for (std::size_t i = 0; i < run_->rows.size(); ++i)
        if (run_->rows[i].session != nullptr)
            guarded(run_->rows[i], [&] {
                prepare(run_->rows[i], 0);
                static_cast<void>(timed_launch(*run_->rows[i].session, job_of(run_->rows[i], 0)));
                if (hash_of_answers(run_->rows[i], 0) != run_->images[i].front().verdict.hit_hash)
                    throw Error(ErrorKind::wrong_result, "the first answers changed when they were asked for again");
                note_compiling(run_->rows[i]);
            });
}

} // namespace tetrace
