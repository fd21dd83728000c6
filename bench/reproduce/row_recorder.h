#pragma once

#include "bench/measuring/machine_watch.h"
#include "bench/reproduce/image_record.h"
#include "bench/reproduce/journal.h"
#include "bench/statistics/interval.h"
#include "core/base/stopwatch.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Rows that do the same work part by part, and the result of each part. A part is a view of a scene, or a batch of
/// searches. Rows end as those of `bench` do: their outcome and samples cover all parts.
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

    void show(const std::string& stage) const;
};

/// Watches the machine through a run, and goes on with the readings of its journal, which may be null. Throws
/// Error{usage} where one of them is damaged.
[[nodiscard]] MachineWatch watch_of(Pulses::Work host, const Journal* journal, Clock clock = host_clock());

/// Takes rows through their parts: verifies each part with every row, times it, and appends it to the journal. Parts
/// that are in the journal are taken from there.
class RowRecorder {
public:
    /// samples: of each row for each part; 0: nothing is timed. sample_s: that each lasts at least.
    RowRecorder(RecordedRows& run, unsigned samples, double sample_s)
        : run_(&run), samples_(samples), sample_s_(sample_s)
    {
    }
    virtual ~RowRecorder() = default;
    RowRecorder(const RowRecorder&) = delete;
    RowRecorder& operator=(const RowRecorder&) = delete;

    /// name: of the scene, or what it is, for the progress line. journal: may be null. watch: takes the pulse between
    /// samples; may be null. Throws Error{usage} if the journal has other parts or other rows, or an entry is
    /// damaged. Of a merged journal nothing is traced: it must have all parts.
    /// budget: of rows that trace views; may skip rows.
    void run(std::size_t parts, const std::string& name, Journal* journal, RunProgress& progress,
             MachineWatch* watch = nullptr, Budget& budget = no_budget());

protected:
    /// Precondition: there is a journal.
    [[noreturn]] void reject_journal(const std::string& why) const { journal_->reject(why); }

private:
    [[nodiscard]] bool is_merged() const { return journal_ != nullptr && journal_->is_merged(); }
    /// The members of a journal entry that identify the part; the answers are added to them.
    [[nodiscard]] virtual nlohmann::json head_of(std::size_t part) const = 0;
    [[nodiscard]] virtual bool is_ours(const nlohmann::json& entry) const = 0;
    /// Throws as reject_journal() does where the entry belongs to another part.
    virtual void check_entry(std::size_t part, const nlohmann::json& entry) const = 0;
    /// Gives the row's session everything that its launches of the part need.
    virtual void prepare(RowRun& row, std::size_t part) = 0;
    [[nodiscard]] virtual TraceJob job_of(const RowRun& row, std::size_t part) const = 0;
    /// Whether the sessions, as the current part has left them, can do job_of() the first part: a GPU's pulse.
    [[nodiscard]] virtual bool can_repeat_first_job() const = 0;
    /// Does the part once and judges every answer; leaves samples empty.
    [[nodiscard]] virtual ImageRecord examine(std::size_t row, std::size_t part) = 0;
    /// Called once if the run is interrupted: only the first parts are complete.
    virtual void keep_first_parts(std::size_t parts) = 0;
    /// Hash of the answers to the last launch, as ImageVerdict::hit_hash.
    [[nodiscard]] virtual std::uint64_t hash_of_answers(RowRun& row, std::size_t part) = 0;

    void watch_rows(const std::string& name);
    void take_pulse_if_due();
    /// Empty if it was interrupted: the rows are as before the part.
    [[nodiscard]] std::optional<nlohmann::json> run_part(std::size_t part, bool is_last);
    void end_before_part(std::size_t part, const std::vector<Outcome>& before);
    void time_rows(std::size_t part);
    void time_group(const std::vector<RowRun*>& group, std::size_t part, const Sampler& sampler);
    void take_sample(RowRun& row, std::size_t part, const Sampler& sampler);
    [[nodiscard]] ImageRecord& record_of(const RowRun& row) { return records_[index_of(row)]; }
    [[nodiscard]] std::size_t index_of(const RowRun& row) const
    {
        return static_cast<std::size_t>(&row - run_->rows.data());
    }
    [[nodiscard]] ImageOutcome outcome(std::size_t i) const;
    [[nodiscard]] std::size_t restore_parts();
    void restore(std::size_t part, const nlohmann::json& entry);
    void restore(std::size_t i, std::size_t part, ImageOutcome outcome);
    void check_record(std::size_t i, std::size_t part, const ImageRecord& record) const;
    void repeat_first_part();

    RecordedRows* run_;
    unsigned samples_;
    double sample_s_;
    Journal* journal_ = nullptr;
    MachineWatch* watch_ = nullptr; ///< null if nothing is timed
    Budget* budget_ = nullptr;
    std::vector<ImageRecord> records_; ///< of the current part, row by row
    std::vector<std::size_t> begun_;   ///< rows that the part began with
};

} // namespace tetrace
