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

/// Everything that results need of one image: a row's answers for a view, and its times.
struct ImageRecord {
    ImageVerdict verdict;
    std::uint64_t chained_hash = 0;     ///< of the hits of all views up to this one, as Traced::hit_hash
    std::uint64_t lost_at_cap = 0;      ///< lost rays whose walk took the maximum number of steps: a cycle
    FlatWalks flawed, any;              ///< of wrong and lost rays; of rays over the whole image
    std::vector<double> samples_s;      ///< device seconds of a pass, sample by sample; empty if nothing was timed
    std::vector<double> wall_samples_s; ///< launch to end, by the host's clock
    /// When each sample began and ended, by the clock of MachineWatch; empty without one.
    std::vector<std::pair<double, double>> sampled_s = {};
    std::uint32_t passes = 1;            ///< of a sample
    std::optional<GpuReadings> gpu = {}; ///< of a GPU that reports any
};

/// A row's result for a view: the image, or the failure that ended the row.
using ImageOutcome = std::variant<ImageRecord, Skipped, Failed>;

/// As the journal stores it. Reading it back gives an equal value, except for the pixels in Verdicts::flawed, which are
/// not stored.
[[nodiscard]] nlohmann::json outcome_json(const ImageOutcome& outcome);
/// Throws nlohmann::json's exceptions or std::logic_error for input that outcome_json() did not write.
[[nodiscard]] ImageOutcome outcome_from_json(const nlohmann::json& json);

} // namespace tetrace
