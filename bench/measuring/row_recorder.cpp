#include "bench/measuring/row_recorder.h"

#include "bench/rows/rows.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace tetrace {

namespace {

using nlohmann::json;

/// The samples of a row that was timed part by part: sample by sample, the sum over the parts.
void sum_up_samples(RowRun& row, const std::vector<ImageRecord>& images)
{
    row.passes = 1;
    row.readings.reset();
    if (traced(row) == nullptr || images.empty()) return;
    row.samples_s.assign(images.front().samples_s.size(), 0);
    row.wall_samples_s = row.samples_s;
    for (const ImageRecord& image : images) {
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
}

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

bool is_whole(const RowRecord& row)
{
    return traced(row) != nullptr && traced(row)->totals.rays > 0;
}

bool is_cdt(const RowRecord& row)
{
    return row.key.kernel.structure == Structure::cdt;
}

void RunProgress::show(const std::string& stage, double within, const std::string& detail) const
{
    const auto fraction = (static_cast<double>(done) + within) / static_cast<double>(std::max<std::size_t>(all, 1));
    const double left_s =
        here == 0 ? -1 : watch.seconds() / static_cast<double>(here) * static_cast<double>(all - done);
    progress_line().show(stage, fraction, left_s, detail);
}

MachineWatch watch_of(Pulses::Work host, const Journal* journal, Clock clock, FindMonitor find_monitor)
{
    std::vector<json> readings;
    double sampled_until_s = 0;
    try {
        if (journal != nullptr)
            for (const json& entry : journal->entries()) {
                if (entry.contains(MachineWatch::entry_key)) readings.push_back(entry[MachineWatch::entry_key]);
                sampled_until_s = std::max(sampled_until_s, last_sample_end(entry));
            }
        return MachineWatch(std::move(host), readings, std::move(clock), sampled_until_s, std::move(find_monitor));
    } catch (const json::exception& error) {
        journal->reject(fmt::format("a reading of the machine in the journal is damaged: {}", error.what()));
    } catch (const std::logic_error& error) {
        journal->reject(fmt::format("a reading of the machine in the journal is damaged: {}", error.what()));
    }
}

std::size_t RowRecorder::run(std::size_t parts, const std::string& name)
{
    const std::string stage = (samples_ > 0 ? "measuring " : "verifying ") + name;
    RunProgress& progress = shared_.progress != nullptr ? *shared_.progress : own_progress_;
    if (shared_.progress == nullptr) progress.all = parts;
    if (samples_ == 0 || is_merged()) shared_.watch = nullptr;
    if (shared_.watch != nullptr) watch_rows(name);
    if (restored_ > 0) something_to_keep();
    std::size_t part = restored_;
    progress.done += part;
    if (is_merged() && part < parts) reject_journal(fmt::format("{}: {} parts of {}", name, part, parts));
    for (; part < parts; ++part) {
        const auto entry = run_part(part, part + 1 == parts, stage);
        if (!entry) break;
        something_to_keep();
        if (shared_.journal != nullptr) shared_.journal->append(*entry);
        progress.done += 1;
        progress.here += 1;
    }
    if (!is_merged() && part == parts) repeat_first_part(stage);
    if (samples_ > 0)
        for (std::size_t i = 0; i < rows_.size(); ++i)
            sum_up_samples(*rows_[i], (*images_)[i]);
    progress_line().clear();
    return part;
}

void RowRecorder::watch_rows(const std::string& name)
{
    const auto first_job_s = [this](RowRun& row) {
        const std::optional<TraceJob> job = pulse_job(row);
        if (!job) return std::optional<double>();
        return median_launch_s(
            row, [&] { return *job; }, host_clock());
    };
    shared_.watch->pulses().watch(rows_, first_job_s, ", " + name);
    shared_.watch->monitors().find(rows_);
    for (std::size_t i = 0; i < rows_.size(); ++i)
        for (const ImageRecord& image : (*images_)[i])
            for (const auto& [begin_s, end_s] : image.sampled_s)
                shared_.watch->pulses().sampled(*rows_[i], begin_s, end_s);
}

/// The journal's entry of the part.
std::optional<json> RowRecorder::run_part(std::size_t part, bool is_last, const std::string& stage)
{
    const Stopwatch watch;
    std::vector<Outcome> before;
    for (const RowRun* row : rows_)
        before.push_back(row->outcome);
    examine_all(part, stage);
    if (samples_ > 0 && !is_interrupted()) {
        const Sampler sampler(sample_s_, *shared_.budget, shared_.watch);
        for (const auto& group : sample_groups(rows_))
            time_group(group, part, sampler);
        if (shared_.watch != nullptr) shared_.watch->pulses().take_if_due();
    }
    if (is_interrupted()) {
        end_before_part(part, before);
        return std::nullopt;
    }
    json entry = head_of(part);
    entry["rows"] = json::object();
    for (const RowRun* row : rows_) // those that have ended, which a run that goes on does not take up again
        if (traced(*row) == nullptr) entry["rows"][row_name(row->key)] = ended_json(row->outcome);
    for (const std::size_t i : begun_) {
        entry["rows"][row_name(rows_[i]->key)] = outcome_json(outcome(i));
        if (traced(*rows_[i]) != nullptr) (*images_)[i].push_back(std::move(records_[i]));
    }
    entry["wall_s"] = watch.seconds();
    if (samples_ > 0) shared_.budget->view_done();
    if (shared_.watch != nullptr)
        if (json readings = shared_.watch->new_readings(is_last); !readings.is_null())
            entry[MachineWatch::entry_key] = std::move(readings);
    return entry;
}

void RowRecorder::examine_all(std::size_t part, const std::string& stage)
{
    const RunProgress& progress = shared_.progress != nullptr ? *shared_.progress : own_progress_;
    Budget& budget = *shared_.budget;
    const double start_s = budget.now();
    double traced_s = 0;
    records_.assign(rows_.size(), {});
    begun_.clear();
    for (std::size_t i = 0; i < rows_.size() && !is_interrupted(); ++i) {
        RowRun& row = *rows_[i];
        progress.show(stage, static_cast<double>(i) / static_cast<double>(rows_.size()),
                      row_label(row.key) + ", " + name_of_part(part));
        if (row.session == nullptr) continue;
        begun_.push_back(i);
        guarded(row, [&] {
            records_[i] = examine(i, part);
            traced_s += records_[i].verdict.wall_s;
            budget.traced(row, 1, records_[i].verdict.wall_s);
            add(i, records_[i]);
        });
        budget.review();
    }
    std::vector<const RowRun*> judged;
    for (const std::size_t i : begun_)
        judged.push_back(rows_[i]);
    budget.judged(judged, budget.now() - start_s - traced_s);
}

/// The images of the part are added to the row's outcome at once: a row that turns out wrong is not timed.
void RowRecorder::add(std::size_t i, const ImageRecord& record)
{
    Traced& sum = std::get<Traced>(rows_[i]->outcome);
    sum.add(record.verdict);
    sum.view_hashes.push_back(record.verdict.hit_hash);
    sum.hit_hash = record.chained_hash; // 0 of merged shards, which chain only their own
}

void RowRecorder::end_before_part(std::size_t part, const std::vector<Outcome>& before)
{
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        RowRun& row = *rows_[i];
        if (traced(row) == nullptr) continue;
        row.outcome = before[i];
        if (part == 0) end_interrupted(row);
    }
}

/// Interleaved, so that drift affects all rows alike. The first launch after another row's warms the caches.
void RowRecorder::time_group(const std::vector<RowRun*>& group, std::size_t part, const Sampler& sampler)
{
    const auto for_timed_rows = [&](const auto& work) {
        for (RowRun* const row : group)
            if (is_timed(*row))
                guarded(*row, [&] {
                    work(Pass{row, 1, [this, row, part](std::size_t) { return prepare(*row, part); }});
                });
    };
    for_timed_rows(
        [&](const Pass& pass) { sampler.warmed_up(*pass.row, run_pass(pass, 1, sampler.clock()).kernel_s); });
    for (unsigned sample = 0; sample < samples_ && !is_interrupted(); ++sample)
        for_timed_rows([&](Pass pass) {
            ImageRecord& record = records_[index_of(*pass.row)];
            // A device that answers differently under repetition must lose its rate.
            if (sample + 1 == samples_)
                pass.after = [&](std::size_t, std::size_t) {
                    if (hash_of_answers(*pass.row, part) != record.verdict.hit_hash)
                        throw Error(ErrorKind::wrong_result,
                                    fmt::format("the answers of {} changed while they were timed", name_of_part(part)));
                };
            sampler.take(pass, record);
        });
}

std::size_t RowRecorder::index_of(const RowRun& row) const
{
    return static_cast<std::size_t>(std::ranges::find(rows_, &row) - rows_.begin());
}

ImageOutcome RowRecorder::outcome(std::size_t i) const
{
    const Outcome& end = rows_[i]->outcome;
    if (const auto* skipped = std::get_if<Skipped>(&end)) return *skipped;
    if (const auto* failed = std::get_if<Failed>(&end)) return *failed;
    return records_[i];
}

std::size_t RowRecorder::restore()
{
    if (shared_.journal == nullptr) return 0;
    std::size_t line = 1; // the head's
    const auto reject = [&](const std::exception& error) {
        reject_journal(fmt::format("line {} of the journal is damaged: {}", line, error.what()));
    };
    for (const json& entry : shared_.journal->entries()) {
        ++line;
        try {
            if (is_ours(entry)) restore(restored_++, entry);
        } catch (const json::exception& error) {
            reject(error);
        } catch (const std::logic_error& error) {
            reject(error);
        }
    }
    for (const RowRun* row : rows_)
        shared_.budget->restored(*row, restored_);
    return restored_;
}

void RowRecorder::restore(std::size_t part, const json& entry)
{
    check_entry(part, entry);
    for (const RowRun* row : rows_)
        if (traced(*row) != nullptr && !entry.at("rows").contains(row_name(row->key)))
            reject_journal(fmt::format("the journal lacks hits of {}, which could not run then", row_name(row->key)));
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (traced(*rows_[i]) != nullptr) restore(i, part, outcome_from_json(entry["rows"][row_name(rows_[i]->key)]));
}

void RowRecorder::restore(std::size_t i, std::size_t part, ImageOutcome outcome)
{
    RowRun& row = *rows_[i];
    if (auto* record = std::get_if<ImageRecord>(&outcome)) {
        add(i, *record);
        check_record(i, part, *record);
        (*images_)[i].push_back(std::move(*record));
        return;
    }
    if (auto* skipped = std::get_if<Skipped>(&outcome)) row.outcome = *skipped;
    if (auto* failed = std::get_if<Failed>(&outcome)) row.outcome = *failed;
    row.session.reset();
}

/// Checks that the record is possible for the row, which already has the part's outcome. Throws std::domain_error.
void RowRecorder::check_record(std::size_t i, std::size_t part, const ImageRecord& record) const
{
    const RowRun& row = *rows_[i];
    const std::size_t rays = rays_of(row, part);
    if (record.verdict.totals.rays != rays)
        throw std::domain_error(
            fmt::format("{} has {} rays, not {}", row_name(row.key), record.verdict.totals.rays, rays));
    // Where several kinds of machines took the samples, a merged journal has none.
    if (is_merged() && record.samples_s.empty() && record.wall_samples_s.empty()) return;
    try {
        require_samples(record, has_answers(row) ? samples_ : 0,
                        shared_.watch != nullptr && samples_ > 0 && !is_merged());
    } catch (const std::domain_error& error) {
        throw std::domain_error(fmt::format("{}: {}", row_name(row.key), error.what()));
    }
}

/// After everything else that the device was given; after a resume, the first part is the journal's.
void RowRecorder::repeat_first_part(const std::string& stage)
{
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        RowRun& row = *rows_[i];
        if (row.session == nullptr || is_interrupted()) continue;
        progress_line().show(stage, 1, -1, row_label(row.key) + ", again");
        const double start_s = shared_.budget->now();
        guarded(row, [&] {
            if (repeat(row, 0) != traced(row)->view_hashes.front())
                throw Error(ErrorKind::wrong_result,
                            fmt::format("the answers of {} changed when it was traced again", name_of_part(0)));
            note_compiling(row);
        });
        shared_.budget->traced(row, 1, shared_.budget->now() - start_s);
    }
}

} // namespace tetrace
