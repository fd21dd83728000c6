#pragma once

#include "bench/rows/row_tracing.h"
#include "bench/statistics/statistics.h"

#include <limits>
#include <string>
#include <vector>

namespace tetrace {

/// Passes of a sample: a launch of Vulkan's lists them all.
inline constexpr std::uint32_t most_passes = 4096;

/// Keeps a run within the seconds of --budget. A row needs a pass over its views to be verified, its first view once
/// more, a warm-up pass, and fewest_samples samples with their passes of single launches (latency_passes()). Where the
/// rows need more than is left, the slowest end as skipped; their text gives their cost and the --budget that runs
/// them. The others get all the time that they need, whatever the order of the rows. openmp's rows that others are
/// compared with are skipped last, and only once rows are being timed.
///
/// Estimates are corrected as rows are traced. plan() holds the rows to the budget itself. Later reviews allow a
/// quarter more, so that noise skips no row. A run takes at most 1.25 budgets plus the pass that is running at that
/// moment.
class Budget {
public:
    /// Starts the clock. seconds: infinity means no limit; then all functions below do nothing.
    explicit Budget(double seconds = std::numeric_limits<double>::infinity(), Clock clock = host_clock());

    [[nodiscard]] const Clock& clock() const { return clock_; }
    [[nodiscard]] double now() const { return clock_(); }
    [[nodiscard]] double left_s() const { return seconds_ - (now() - start_s_); }

    /// Restarts the clock, estimates the rows by tracing a part of their rays, and skips those that do not fit. Rows
    /// that cannot be traced end with their reason. rows: opened; they keep their addresses while the budget is used.
    /// samples: the number asked for, in each of so many runs. sample_s: that each lasts at least. Throws Error{usage}
    /// where no row fits, or not all of openmp's rows that others are compared with.
    void plan(std::vector<RowRun>& rows, unsigned samples, double sample_s = 0, unsigned runs = 1);

    /// Records that some views of a row took this many seconds.
    void traced(const RowRun& row, std::size_t views, double seconds);
    /// Records that all rows of a view were judged; seconds: without the tracing.
    void judged(double seconds);

    /// Skips the slowest rows until the others fit. Throws as plan() does.
    void review();
    /// The same while rows are timed: may also skip openmp's rows, and throws nothing.
    void review_timed();

private:
    struct Entry {
        RowRun* row = nullptr;
        bool is_reference = false; ///< others are compared with it
        double view_s = 0;         ///< expected
        double views_left = 0;     ///< to verify and to warm up
        double views = 0, samples = 0, sample_s = 0, runs = 1;
        double seen_s = 0, seen_views = 0;

        [[nodiscard]] double need_s() const;
    };

    [[nodiscard]] double judging_s() const
    {
        return judged_views_ == 0 ? 0 : judged_s_ / judged_views_ * std::max(0.0, views_to_judge_ - judged_views_);
    }
    [[nodiscard]] double needed_s(bool by_references_only = false) const;
    [[nodiscard]] Entry* slowest(bool among_references);
    void skip(Entry& entry, double affordable_s);
    bool skip_slowest(double affordable_s, bool among_references);
    void fit(double affordable_s);
    [[noreturn]] void reject(const std::string& who, double need_s) const;
    [[nodiscard]] std::string sufficient() const;

    double seconds_;
    Clock clock_;
    double start_s_;
    std::vector<Entry> entries_;
    double skipped_s_ = 0; ///< time that the skipped rows would have needed
    double judged_s_ = 0, judged_views_ = 0;
    double views_to_judge_ = 0; ///< of all scenes
};

/// For runs without a limit.
[[nodiscard]] Budget& no_budget();

} // namespace tetrace
