#pragma once

#include "bench/measuring/machine_load.h"
#include "bench/rows/row_tracing.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// How long a fixed short piece of work took, repeated throughout a run: only the machine changes it. Printed as
/// calibration.
struct Pulse {
    struct Reading {
        double at_s;    ///< when it began, by the clock of the samples
        double seconds; ///< what the work took
    };
    std::string of;                ///< "host", or a GPU's name
    std::vector<Reading> readings; ///< in the order of time

    /// Precondition of these: there is a reading.
    [[nodiscard]] double fastest_s() const;
    /// The slowest over the fastest.
    [[nodiscard]] double ratio() const;
    /// Of the last reading before an interval and the first one after it, the slower one over the fastest of all.
    [[nodiscard]] double ratio_beside(double begin_s, double end_s) const;
};

/// Takes the pulse of the host, and of every GPU that rows are timed on: before the samples, between them at most every
/// other second, and after them. The host's work is its own. A GPU's is that of the first row that is timed on it;
/// where that row fails, its pulse ends.
class Pulses {
public:
    /// Returns seconds; empty: this and all further readings are left out.
    using Work = std::function<std::optional<double>()>;
    /// The same of a row, on its device.
    using RowWork = std::function<std::optional<double>(RowRun&)>;

    /// host: its work.
    Pulses(Work host, Clock clock);
    /// rows: watched, each GPU by the last view of its first row.
    Pulses(const std::vector<RowRun*>& rows, Work host, Clock clock);
    /// periods: how many a CPU quota has stopped this process in so far; tests pass their own.
    void set_throttled_periods(std::function<std::uint64_t()> periods);
    Pulses(const Pulses&) = delete;
    Pulses& operator=(const Pulses&) = delete;

    /// From here on these rows are sampled, and the pulses of GPUs are theirs: those of rows that were watched before
    /// end. The next reading is due.
    /// rows: opened; they keep their addresses. gpu: what the first row that is timed on each GPU does. of: a GPU's
    /// pulse is that of its name with this appended, continued where one is known.
    void watch(const std::vector<RowRun*>& rows, const RowWork& gpu, const std::string& of = {});
    /// Readings of an earlier process of the same run, older than all of this one.
    void restore(const Pulse& pulse);

    void take();
    /// The same, unless the last time was a moment ago.
    void take_if_due();
    /// Records when a sample of the row was taken; of rows that are not watched, nothing.
    void sampled(const RowRun& row, double begin_s, double end_s);
    /// Tells each row that was sampled what its pulse and the load say about its rate.
    void judge_rows(std::vector<RowRun>& rows, const std::optional<MachineLoad>& load) const;

    /// Those with a reading.
    [[nodiscard]] std::vector<Pulse> found() const;

private:
    struct Taker {
        Pulse pulse;
        Work work;
        bool ended = false;
    };
    [[nodiscard]] std::size_t taker_of(const std::string& of);

    struct Samples {
        std::size_t taker;
        std::vector<std::pair<double, double>> intervals;
        std::uint64_t throttled = 0; ///< periods in which a CPU quota stopped the process
    };

    Clock clock_;
    std::vector<Taker> takers_;
    std::map<const RowRun*, Samples> rows_;
    std::function<std::uint64_t()> throttled_periods_; ///< null without a quota
    std::uint64_t throttled_ = 0;                      ///< counted so far
    std::optional<double> last_s_;                     ///< of the last reading; empty: one is due
};

/// The calibration work of the host: openmp::pulse_s() by this many threads.
[[nodiscard]] Pulses::Work host_pulse(unsigned threads);

/// The calibration work of a GPU: the last view of the row that has rays, by median_launch_s().
[[nodiscard]] Pulses::RowWork last_view_pulse(Clock clock);

/// The median of three times that a row's session takes for a job, for its GPU's pulse. Empty if the row is not
/// timed or fails, which is then its outcome.
[[nodiscard]] std::optional<double> median_launch_s(RowRun& row, const std::function<TraceJob()>& job,
                                                    const Clock& clock);

/// Why a row's rate is not to be trusted although its samples agree; empty if nothing speaks against it.
/// pulse_ratio: the median over its samples of Pulse::ratio_beside(). load: null for rows that do not run on the host.
[[nodiscard]] std::string disturbance_text(std::optional<double> pulse_ratio, const MachineLoad* load);

} // namespace tetrace
