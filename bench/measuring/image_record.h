#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

namespace tetrace {

/// The number of rays that walk through a flat tet, among those looked at.
struct FlatWalks {
    std::uint64_t rays = 0;
    std::uint64_t through_flat = 0;
};

/// Samples of a row's work, in the order in which they were taken.
struct RowSamples {
    std::vector<double> samples_s = {};                    ///< device seconds of a pass
    std::vector<double> wall_samples_s = {};               ///< of a pass, launch to end, by the host's clock
    std::vector<double> latency_samples_s = {};            ///< as RowRecord::latency_samples_s
    std::vector<std::pair<double, double>> sampled_s = {}; ///< begin and end of each, by the clock of MachineWatch
    std::uint32_t passes = 1;                              ///< of a sample
    std::optional<GpuReadings> gpu = {};                   ///< of a GPU that reports any
};

/// Everything that results need of one image: a row's answers for a view, and its samples where the view was timed by
/// itself.
struct ImageRecord : RowSamples {
    ImageVerdict verdict;
    std::uint64_t chained_hash = 0; ///< of the hits of all views up to this one, as Traced::hit_hash
    std::uint64_t lost_at_cap = 0;  ///< lost rays whose walk took the maximum number of steps: a cycle
    FlatWalks flawed, any;          ///< of wrong and lost rays; of rays over the whole image
};

/// A row's result for a view: the image, or the failure that ended the row.
using ImageOutcome = std::variant<ImageRecord, Skipped, Failed>;

/// As the journal stores it. Reading it back gives an equal value, except for the pixels in Verdicts::flawed, which are
/// not stored.
[[nodiscard]] nlohmann::json outcome_json(const ImageOutcome& outcome);
/// Throws nlohmann::json's exceptions or std::logic_error for input that outcome_json() did not write.
[[nodiscard]] ImageOutcome outcome_from_json(const nlohmann::json& json);

/// The same for how a row ended that is without hits. Precondition: it has ended so.
[[nodiscard]] nlohmann::json ended_json(const Outcome& outcome);
/// Throws as outcome_from_json() does, and std::domain_error for an image.
[[nodiscard]] Outcome ended_from(const nlohmann::json& json);

/// The same for samples of all views together.
[[nodiscard]] nlohmann::json samples_json(const RowSamples& samples);
/// Throws nlohmann::json's exceptions or std::logic_error for input that samples_json() did not write, and for times
/// that cannot be.
[[nodiscard]] RowSamples samples_from(const nlohmann::json& json);
/// Empties the samples in JSON of samples_json() or outcome_json(), if it has any; when they were taken stays.
void drop_samples(nlohmann::json& record);
/// Throws std::domain_error unless there are that many samples, each with possible times. with_intervals: whether each
/// must say when it was taken.
void require_samples(const RowSamples& samples, std::size_t count, bool with_intervals);

} // namespace tetrace
