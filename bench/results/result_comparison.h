#pragma once

#include "bench/results/result_file.h"
#include "bench/statistics/speed_verdict.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// The scene that a row was timed on. Throws Error{invalid_input} naming file and row where the file does not have it.
[[nodiscard]] const ResultScene& scene_of(const ResultFile& file, const ResultRow& row);

/// Why two rows of equal names, of results A and B, did not do the same work: their scenes (of rows of BVHs, only the
/// scenes' meshes), views, sizes or hit hashes differ, or on a GPU the numbers of launches; of exit searches, their
/// number or the hash of their faces. Empty where they did the same. Throws as scene_of() does.
[[nodiscard]] std::string different_work(const ResultFile& a, const ResultRow& row_a, const ResultFile& b,
                                         const ResultRow& row_b);

/// The part of that which is known before any answer: what rays are traced through what, and the options that would do
/// A's work again. Empty for exit searches. Throws as scene_of() does.
[[nodiscard]] std::string different_rays(const ResultFile& a, const ResultRow& row_a, const ResultFile& b,
                                         const ResultRow& row_b);

/// Equal texts are the same rays through the same scene, or the same searches. Throws as scene_of() does.
[[nodiscard]] std::string rays_of(const ResultFile& file, const ResultRow& row);

/// Equal texts are the same work: the same row with the same rays and the same answers. Empty for a row that has no
/// hash of its answers, whose work nobody can tell. Throws as scene_of() does.
[[nodiscard]] std::string work_of(const ResultFile& file, const ResultRow& row);

/// What shows whether the machine kept its speed while a row was timed.
struct RatePulse {
    std::optional<double> ratio;  ///< of calibration during the row's samples to its run's fastest
    std::optional<double> host_s; ///< the run's fastest pulse of the host, of rows on the host; empty where not taken

    /// Whether the rate is noisy because of calibration: noisy_pulse (bench/statistics/statistics.h) or more.
    [[nodiscard]] bool is_noisy() const;
};

[[nodiscard]] RatePulse pulse_of(const ResultHead& head, const ResultRow& row);

/// Why the machine, and not the row, may have changed between two rates: "NOISY" for `compare` and for the page of a
/// folder. Empty if nothing says so. same_machine: with as many threads; of others the comparison is to tell.
/// names: of the two, as in "in A the pulse ...".
[[nodiscard]] std::string disturbance_between(const RatePulse& before, const RatePulse& after, bool same_machine,
                                              const std::string& before_name = "A",
                                              const std::string& after_name = "B");

/// How a row of one or both results compares.
enum class RowOutcome {
    compared,  ///< timed in both
    different, ///< timed in both, but not of the same work: scene, views, size or hits differ
    failed,    ///< timed before; wrong or in error after
    missing,   ///< timed before; missing, skipped, unsupported or without samples after
    added,     ///< only timed after
    untimed,   ///< timed in neither
    agreed,    ///< timed in both, under two APIs, with the same answers; rates of two APIs are not compared
};

/// A row of two results. Refers to them.
struct ComparedRow {
    const ResultRow* before = nullptr; ///< null if the result lacks the row
    const ResultRow* after = nullptr;  ///< the same; one of the two is there
    RowOutcome outcome = RowOutcome::untimed;
    std::optional<SpeedChange> change; ///< of compared rows
    std::string difference;            ///< of rows that did different work: what differs
    std::string disturbance = {};      ///< of compared rows: why the machine, and not the row, may have changed

    [[nodiscard]] const std::string& name() const { return (before != nullptr ? before : after)->name; }
    /// "SAME", "FASTER", "SLOWER", "UNSURE" and "NOISY" of compared rows; else "DIFFERENT", "FAILED", "MISSING", "NEW",
    /// "NOT TIMED" or "SAME ANSWERS".
    [[nodiscard]] std::string verdict() const;
    /// Compared only by its medians: the samples allow no interval, so that its verdict is "UNSURE" however far the
    /// medians lie apart.
    [[nodiscard]] bool has_too_few_samples() const { return change && !change->interval; }
    /// Compared, but the machine was not the same in both: the verdict is "NOISY" whatever the interval says. A row
    /// without an interval is "UNSURE" in any case.
    [[nodiscard]] bool is_noisy() const { return !disturbance.empty(); }
    /// Why the row is not compared, "B: skipped: no device", with B for after and A for before, or what differs; that a
    /// compared row has too few samples, or what disturbed it; else empty.
    [[nodiscard]] std::string note() const;
};

/// Two results, row by row. Refers to them.
struct ResultComparison {
    const ResultFile* before = nullptr;
    const ResultFile* after = nullptr;
    double tolerance = 0;
    std::vector<ComparedRow> rows; ///< in the order of before, then those that only after has

    [[nodiscard]] std::size_t count(RowOutcome outcome) const;
    /// Of the ratios of compared rows; empty without any. It excludes rows that failed or are missing.
    [[nodiscard]] std::optional<double> geometric_mean() const;
    /// The chance, at most, that any compared row is called faster or slower where nothing changed: comparison_error,
    /// or more where rows have few samples.
    [[nodiscard]] double error() const;
    /// The regressions of `after`: compared rows that are slower by more than the tolerance and not noisy, failed rows,
    /// and missing ones unless those are allowed, or the two have no API in common.
    [[nodiscard]] std::vector<const ComparedRow*> regressions(bool allow_missing) const;
};

/// Compares rows of equal names, and where the results have no API in common, a row of one API with that of another,
/// for their answers alone; of those whose name the regular expression matches (bench/options/name_filter.h;
/// empty: all). A row timed in both whose scenes' hashes, views, sizes or hit hashes differ did different work, and is
/// not compared; so did exit searches of other numbers (bench/results/result_comparison.h). A row is noisy where its
/// pulse moved by noisy_pulse (bench/statistics/statistics.h) in either run, or, on the host and one machine, between
/// the two. Throws Error{invalid_input} if all such rows did different work, with the reasons; and if there is nothing
/// to compare: before lacks timed rows, or the two share no row.
[[nodiscard]] ResultComparison compare_results(const ResultFile& before, const ResultFile& after,
                                               const std::string& filter, double tolerance);

} // namespace tetrace
