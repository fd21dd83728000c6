#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

namespace tetrace {

/// Of the rays looked at, how many walk through a flat tet.
struct FlatWalks {
    std::uint64_t rays = 0;
    std::uint64_t through_flat = 0;
};

/// All that results need of one image: a row's answers for a view, and its times.
struct ImageRecord {
    ImageVerdict verdict;
    std::uint64_t chained_hash = 0;     ///< of the hits of all views so far, as Traced::hit_hash
    std::uint64_t lost_at_cap = 0;      ///< lost rays whose walk took as many steps as it may: a cycle
    FlatWalks flawed, any;              ///< of wrong and lost rays; of rays all over the image
    std::vector<double> samples_s;      ///< device seconds, a launch each; empty where nothing was timed
    std::vector<double> wall_samples_s; ///< launch to end, on the host's clock
};

/// How a row came through a view: with its image, or at its end.
using ImageOutcome = std::variant<ImageRecord, Skipped, Failed>;

/// As the journal holds it; what comes back is equal but for Verdicts::flawed, the pixels, which are left out.
[[nodiscard]] nlohmann::json outcome_json(const ImageOutcome& outcome);
/// Throws nlohmann::json's exceptions or std::logic_error for what outcome_json() did not write.
[[nodiscard]] ImageOutcome outcome_from_json(const nlohmann::json& json);

} // namespace tetrace
