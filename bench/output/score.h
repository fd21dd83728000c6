#pragma once

#include "bench/options/workload.h"
#include "bench/rows/row_record.h"
#include "bench/statistics/rank_interval.h"
#include "bench/terminal/table.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// The workload that a run did: all of its scenes, with its cameras, views, size and kinds of rays. Null if it did
/// other work, or more. Hashes decide: of scenes, cameras and given rays. scenes: as results record them; throws
/// Error{invalid_input} if one is not a scene.
[[nodiscard]] const Workload* workload_of(const std::vector<nlohmann::json>& scenes,
                                          const std::vector<RowRecord>& rows);

/// A kernel in one place: a device, with its threads. Its score is the geometric mean over a workload.
struct Score {
    std::vector<const RowRecord*> rows; ///< of each scene and kind of rays
    double mrays_per_s = 0;             ///< geometric mean of the rows that have a rate; a score if there is no reason
    FactorInterval interval = {};       ///< of a score: 95 %, from the samples of one run; the range of several runs
    std::string reason; ///< why it is no score: not a workload, a row missing, not ok or noisy, or too few samples

    /// "cdt project half32".
    [[nodiscard]] std::string title() const;
    [[nodiscard]] bool is_score() const { return reason.empty(); }
    /// "12.34 [12.20, 12.50]"; empty if it is no score.
    [[nodiscard]] std::string text() const;
};

/// The kernels of a run, the fastest first. workload: as of workload_of(); null: none of them has a score.
[[nodiscard]] std::vector<Score> scores_of(const Workload* workload, const std::vector<RowRecord>& rows);

/// One line per score, with the rate of each of its rows.
[[nodiscard]] Table score_table(const std::vector<Score>& scores, bool with_reasons = true);

/// In a result, under "scores".
[[nodiscard]] nlohmann::json scores_json(const std::vector<Score>& scores);

} // namespace tetrace
