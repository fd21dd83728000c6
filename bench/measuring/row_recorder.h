#pragma once

#include "bench/measuring/journal.h"
#include "bench/measuring/sampler.h"
#include "bench/statistics/statistics.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Rows that do the same work part by part, and the result of each part. A part is a view of a scene, or a batch of
/// searches.
struct RecordedRows {
    std::vector<RowRun> rows;
    std::vector<std::vector<ImageRecord>> images; ///< row by row, part by part; fewer where a row failed
    Sampling sampling = Sampling::even;           ///< how the parts were sampled from the whole set
};

/// Whether the row completed all parts with an answer.
[[nodiscard]] bool is_whole(const RowRecord& row);

/// Whether the row is one of the CDT, not of a BVH compared with it.
[[nodiscard]] bool is_cdt(const RowRecord& row);

/// A run's progress, for the progress line.
struct RunProgress {
    std::size_t all = 0;  ///< parts of the whole run
    std::size_t done = 0; ///< including those of a journal
    std::size_t here = 0; ///< done by this process
    Stopwatch watch;

    /// within: of the part that is being done, from 0 to 1. detail: what is worked on.
    void show(const std::string& stage, double within = 0, const std::string& detail = {}) const;
};

/// Watches the machine through a run, and goes on with the readings of its journal, which may be null. clock: of its
/// first process. Throws Error{usage} where one of them is damaged.
[[nodiscard]] MachineWatch watch_of(Pulses::Work host, const Journal* journal, Clock clock = host_clock(),
                                    FindMonitor find_monitor = find_gpu_monitor);

/// What the recorders of a run share. All pointers may be null but that of the budget.
struct Recording {
    Journal* journal = nullptr;      ///< where parts are kept
    RunProgress* progress = nullptr; ///< null: each recorder has its own
    MachineWatch* watch = nullptr;   ///< takes the pulse between samples
    Budget* budget = &no_budget();   ///< may skip rows
};

/// Takes rows through their parts: verifies each part with every row, times it where samples are asked for, and appends
/// it to the journal; at last repeats the first part, whose answers must be the same. Parts that are in the journal are
/// taken from there. `check` and `bench` record without samples: `bench` takes them of all views and scenes together
/// (measure_rows()); `reproduce` takes them part by part.
class RowRecorder {
public:
    /// rows: opened; of the images, which are as many, each gets its row's. They must outlive the recorder.
    /// samples: of each row for each part; 0: nothing is timed. sample_s: that each lasts at least.
    RowRecorder(std::vector<RowRun*> rows, std::vector<std::vector<ImageRecord>>& images, unsigned samples,
                double sample_s, const Recording& shared)
        : rows_(std::move(rows)), images_(&images), samples_(samples), sample_s_(sample_s), shared_(shared)
    {
        images_->resize(rows_.size());
    }
    virtual ~RowRecorder() = default;
    RowRecorder(const RowRecorder&) = delete;
    RowRecorder& operator=(const RowRecorder&) = delete;

    /// Takes the parts that the journal has, and returns their number. Throws Error{usage} if the journal has other
    /// parts or other rows, or an entry is damaged.
    [[nodiscard]] std::size_t restore();
    /// Does the parts that restore() has not taken, which was called before; returns how many all rows have completed:
    /// fewer than `parts` after an interrupt. Rows that were interrupted in their first part end as skipped. Of a
    /// merged journal nothing is traced: it must have all parts, else Error{usage} is thrown.
    /// name: of the scene, or what it is, for the progress line and for the pulse of GPUs.
    std::size_t run(std::size_t parts, const std::string& name);

protected:
    /// Precondition: there is a journal.
    [[noreturn]] void reject_journal(const std::string& why) const { shared_.journal->reject(why); }
    [[nodiscard]] const std::vector<RowRun*>& rows() const { return rows_; }
    /// Of the answers to all parts, of which these are the next ones.
    template <class Answers>
    [[nodiscard]] std::uint64_t chained_hash(std::size_t i, const Answers& answers) const
    {
        const auto& before = (*images_)[i];
        return hash_of(answers, before.empty() ? 0 : before.back().chained_hash);
    }

private:
    [[nodiscard]] bool is_merged() const { return shared_.journal != nullptr && shared_.journal->is_merged(); }
    /// The members of a journal entry that identify the part; the answers are added to them.
    [[nodiscard]] virtual nlohmann::json head_of(std::size_t part) const = 0;
    [[nodiscard]] virtual bool is_ours(const nlohmann::json& entry) const = 0;
    /// Throws as reject_journal() does where the entry belongs to another part.
    virtual void check_entry(std::size_t part, const nlohmann::json& entry) const = 0;
    /// "view 17": for messages.
    [[nodiscard]] virtual std::string name_of_part(std::size_t part) const = 0;
    /// Rays of the part.
    [[nodiscard]] virtual std::size_t rays_of(const RowRun& row, std::size_t part) const = 0;
    /// Gives the row's session everything that a launch of the part needs.
    [[nodiscard]] virtual std::vector<TraceJob> prepare(RowRun& row, std::size_t part) = 0;
    /// The same work at every call, for a GPU's pulse; empty if the sessions cannot do it now.
    [[nodiscard]] virtual std::optional<TraceJob> pulse_job(RowRun& row) = 0;
    /// Does the part once and judges every answer; leaves samples empty.
    [[nodiscard]] virtual ImageRecord examine(std::size_t row, std::size_t part) = 0;
    /// Hash of the answers to the last launch, as ImageVerdict::hit_hash.
    [[nodiscard]] virtual std::uint64_t hash_of_answers(RowRun& row, std::size_t part) = 0;
    /// Does the part once more; returns what hash_of_answers() does. The row has done all parts.
    [[nodiscard]] virtual std::uint64_t repeat(RowRun& row, std::size_t part) = 0;

    void watch_rows(const std::string& name);
    /// Empty if it was interrupted: the rows are as before the part.
    [[nodiscard]] std::optional<nlohmann::json> run_part(std::size_t part, bool is_last, const std::string& stage);
    void examine_all(std::size_t part, const std::string& stage);
    void end_before_part(std::size_t part, const std::vector<Outcome>& before);
    void time_group(const std::vector<RowRun*>& group, std::size_t part, const Sampler& sampler);
    [[nodiscard]] std::size_t index_of(const RowRun& row) const;
    [[nodiscard]] ImageOutcome outcome(std::size_t i) const;
    void add(std::size_t i, const ImageRecord& record);
    void restore(std::size_t part, const nlohmann::json& entry);
    void restore(std::size_t i, std::size_t part, ImageOutcome outcome);
    void check_record(std::size_t i, std::size_t part, const ImageRecord& record) const;
    void repeat_first_part(const std::string& stage);

    std::vector<RowRun*> rows_;
    std::vector<std::vector<ImageRecord>>* images_;
    unsigned samples_;
    double sample_s_;
    Recording shared_;
    RunProgress own_progress_;
    std::size_t restored_ = 0;         ///< parts
    std::vector<ImageRecord> records_; ///< of the current part, row by row
    std::vector<std::size_t> begun_;   ///< rows that the part began with
};

} // namespace tetrace
