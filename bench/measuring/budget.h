#pragma once

#include "bench/rows/row_tracing.h"
#include "bench/statistics/statistics.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// Passes of a sample: a launch of Vulkan's lists them all.
inline constexpr std::uint32_t max_passes = 4096;

/// What the reasons of rows that Budget skips have in common: the --budget that runs all of them follows.
inline constexpr const char* with_budget = "; with --budget ";

/// Keeps a run within the seconds of --budget. A row needs a pass over its views to be verified, its first view once
/// more, the judging of its rays, a warm-up pass, and min_samples samples with their passes of single launches
/// (latency_passes()). If the rows need more than is left, some end as skipped; their text gives their cost and the
/// --budget that runs them. The others get all the time that they need, whatever the order of the rows.
///
/// A run is to compare tets with BVHs. So the slowest rows are skipped first, but of each scene and kind of rays the
/// fastest row of either structure stays; then whole such groups, the last one first; of the first group the slower of
/// the two. If openmp's rows that others are compared with do not fit by themselves, groups are skipped, too, and of
/// the first one the slowest kernels of openmp with the rows that are compared with them. One row is left: of openmp,
/// where others are compared with it.
///
/// What judging a ray costs is known once the rows of a first view were judged.
///
/// Estimates are corrected as rows are traced. plan() holds the rows to the budget itself. Later reviews allow a
/// quarter more, so that noise skips no row. A run takes at most 1.25 budgets plus the pass that is running at that
/// moment; if the last row with the judging of its scene takes longer, as long as these: one row is always measured.
class Budget {
public:
    /// Starts the clock. seconds: infinity means no limit; then all functions below do nothing. shares: the whole run
    /// has this many times as much, which is what messages name.
    explicit Budget(double seconds = std::numeric_limits<double>::infinity(), Clock clock = host_clock(),
                    double shares = 1);

    [[nodiscard]] const Clock& clock() const { return clock_; }
    [[nodiscard]] bool is_limited() const { return seconds_ < std::numeric_limits<double>::infinity(); }
    [[nodiscard]] double now() const { return clock_(); }
    [[nodiscard]] double spent_s() const { return now() - start_s_; }
    [[nodiscard]] double left_s() const { return seconds_ - spent_s(); }

    /// Restarts the clock, estimates the rows by tracing a part of their rays, and skips those that do not fit. Rows
    /// that cannot be traced end with their reason. rows: opened; they keep their addresses while the budget is used.
    /// samples: the number asked for, in each of the runs; 0: rows are only verified. sample_s: that each lasts at
    /// least. Says so if the last row does not fit.
    void plan(std::vector<RowRun>& rows, unsigned samples, double sample_s = 0, unsigned runs = 1);
    /// The same for rows that are verified and timed view by view, in samples of a view, from the view `first` on.
    void plan_views(std::vector<RowRun>& rows, unsigned samples, double sample_s, std::size_t first);
    /// The same for rows of task search, which do this many more batches. quads: the rays of a batch, as sessions get
    /// them; each session then has some of them. Any row can be skipped, as a reference is kept apart from the rows.
    void plan_batches(std::vector<RowRun>& rows, unsigned samples, double sample_s, std::size_t batches,
                      std::span<const Quad> quads);
    /// Records that a view of plan_views() or a batch of plan_batches() has been timed, and skips rows until the others
    /// fit.
    void view_done();

    /// Records that this number of views of a row need not be traced and judged: a journal has them.
    void restored(const RowRun& row, std::size_t views);
    /// Records that some views of a row took this many seconds.
    void traced(const RowRun& row, std::size_t views, double seconds);
    /// Records that a view of these rows was judged; seconds: of all of them, without the tracing.
    void judged(std::span<const RowRun* const> rows, double seconds);

    /// Skips rows until the others fit.
    void review();
    /// The same while rows are timed, when nothing is compared any more.
    void review_timed();

private:
    struct Entry {
        RowRun* row = nullptr;
        bool is_reference = false; ///< others are compared with it
        double view_s = 0;         ///< expected
        double views_left = 0;     ///< to verify and to warm up
        double views_to_judge = 0, view_rays = 0;
        double views = 0, samples = 0, sample_s = 0, runs = 1;
        double views_per_sample = 0;
        double seen_s = 0, seen_views = 0;
        std::optional<double> skipped_s = {}; ///< what it needed when it was skipped

        [[nodiscard]] double launches_s() const;
        /// The same scene and kind of rays.
        [[nodiscard]] bool is_in_group_of(const Entry& other) const;
    };

    /// What a row does: views, or batches of searches.
    struct Parts {
        std::size_t count = 0; ///< that are left
        std::size_t rays = 0;  ///< of one of them
        unsigned max_step = 1; ///< of the probes
        /// Gives the session what the returned job needs, which traces 1 of step * step of the rays.
        std::function<TraceJob(unsigned step)> prepare = {};
    };
    using PartsOf = std::function<Parts(RowRun&)>;

    [[nodiscard]] static Parts views_of(RowRun& row, std::size_t first);
    [[nodiscard]] double estimated_part_s(RowRun& row, const Parts& parts, double enough_s) const;
    void plan(std::vector<RowRun>& rows, const Entry& samples, const PartsOf& parts_of, bool part_by_part);
    [[nodiscard]] double need_s(const Entry& entry) const;
    [[nodiscard]] double needed_s(bool by_references_only = false) const;
    [[nodiscard]] std::size_t alive() const;
    /// Whether its scene and kind of rays have a faster row of its structure, so that a comparison does without it.
    [[nodiscard]] bool is_spare(const Entry& entry) const;
    template <class Is>
    [[nodiscard]] Entry* slowest(const Is& is);
    void skip(Entry& entry);
    bool skip_slowest_spare();
    bool skip_last_group();
    bool skip_slowest_reference();
    bool skip_slowest(double affordable_s, bool among_references);
    void fit(double affordable_s);
    [[nodiscard]] std::string sufficient() const;

    double seconds_, shares_;
    Clock clock_;
    double start_s_;
    std::vector<Entry> entries_;
    double skipped_s_ = 0; ///< time that the skipped rows would have needed
    double judged_s_ = 0, judged_rays_ = 0;
};

/// For runs without a limit.
[[nodiscard]] Budget& no_budget();

} // namespace tetrace
