#pragma once

#include "bench/output/bench_report.h"
#include "bench/reproduce/tables/volume.h"
#include "bench/verbs/kept_parts.h"

#include <vector>

namespace tetrace {

/// All data of `reproduce volume`.
struct Volume {
    BenchResult result;
    std::vector<SceneLines> lines;
};

/// A scene of the page: its name in rows, and the options that ask for it alone.
struct VolumeScene {
    std::string label;
    Options options;
};

/// What is not named: the methods that walk through all tets, each on the layouts that are made for it, on openmp with
/// one thread and with all, also in packets.
[[nodiscard]] Options volume_options(Options options);

/// The scenes of the options; or, if they name none, bunny with both kinds of tets, a lattice, random points, nested
/// spheres, and a lattice that is written as a file of tets and read again. missing: gets why one is left out.
[[nodiscard]] std::vector<VolumeScene> volume_scenes(const Options& options, std::vector<std::string>& missing);

/// What determines the answers of all these rows.
[[nodiscard]] nlohmann::json volume_head(const Options& options, const std::vector<VolumeScene>& scenes);

/// Runs tasks segments, tally and absorb on each scene, which is kept then. A scene for which the budget has no time is
/// left out; the result says why. One that cannot be built has rows of errors.
[[nodiscard]] Volume run_volume(const Options& options, const std::vector<VolumeScene>& scenes, KeptParts& kept);

} // namespace tetrace
