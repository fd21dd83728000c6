#pragma once

#include "bench/merging/shard_results.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// What a run of `reproduce` took, by the clock of the wall, part by part.
struct MeasuredScene {
    std::string name;            ///< label; of searches "exit searches"
    double open_s = 0;           ///< loading it and opening its rows, which every rank with a part of it does; the mean
    std::vector<double> parts_s; ///< views or batches, in their order: verified, timed, written to the journal
    bool is_of_views = true;
};

/// From entries of the journals of all shards, in the order of the whole run. Those of a tetrace that did not measure
/// them give none.
[[nodiscard]] std::vector<MeasuredScene> measured_scenes(const std::vector<ShardResult>& shards);

/// The same with all views of a camera set: each measured view stands for those near it.
[[nodiscard]] std::vector<MeasuredScene> of_all_views(std::vector<MeasuredScene> scenes, std::size_t population);

/// A run by so many ranks, by simulation: parts are dealt out by number, every rank takes as long for a part as it was
/// measured to take, and ranks do not slow each other down.
struct SimulatedRun {
    unsigned ranks = 1;
    double seconds = 0;      ///< of the slowest rank
    double open_s = 0;       ///< of these, opening scenes
    double mean_s = 0;       ///< mean over the ranks
    std::size_t without = 0; ///< ranks without any part
};
[[nodiscard]] SimulatedRun simulate(const std::vector<MeasuredScene>& scenes, unsigned ranks);

/// The runs by these numbers of ranks, of the views that were measured and of all of the camera set, with what no
/// number of ranks goes below: opening the scenes, and the longest part. Throws Error{usage} where nothing was
/// measured.
[[nodiscard]] Sheet scaling_sheet(const std::vector<MeasuredScene>& scenes, const std::vector<unsigned>& ranks,
                                  std::size_t population);

} // namespace tetrace
