#pragma once

#include "bench/output/bench_report.h"
#include "bench/reproduce/tables/volume.h"

#include <vector>

namespace tetrace {

/// All data of `reproduce volume`.
struct Volume {
    BenchResult result;
    std::vector<SceneLines> lines;
};

/// Runs tasks segments, tally and absorb on each scene: those of the options; or, if they name none, bunny with both
/// kinds of tets, a lattice, random points, nested spheres, and a lattice that is written as a file of tets and read
/// again. A scene whose mesh is not here, or for which the budget has no time, is left out; the result says
/// why. One that cannot be built has rows of errors.
[[nodiscard]] Volume run_volume(const Options& options);

} // namespace tetrace
