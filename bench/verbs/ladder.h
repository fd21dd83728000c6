#pragma once

#include "bench/measuring/lone_rays.h"
#include "bench/output/bench_report.h"
#include "bench/verbs/kept_parts.h"

#include <vector>

namespace tetrace {

/// All data of `reproduce ladder`.
struct Ladder {
    BenchResult result;
    std::vector<StepCosts> costs; ///< of the result's rows
};

/// The options of `reproduce ladder` with what is not named: lattices whose half32 takes 1 MB to 4 GB, four times more
/// each; half32, tet64 and bvh2 in one form each.
[[nodiscard]] Options ladder_options(Options options);

/// Adds a timed part to those of other scenes. A scene that the result has already is left out. scene: for the names of
/// GPUs' pulses; empty if they have it.
void append(BenchResult& to, KeptPart part, const std::string& scene);

/// Measures scene after scene, in the order of the options: each is closed before the next is made, and kept. A scene
/// that the machine's memory cannot hold, or for which the budget has no time, is left out; the
/// result says why. rows: of those options.
[[nodiscard]] Ladder run_ladder(const Options& options, const std::vector<RowKey>& rows, KeptParts& kept);

} // namespace tetrace
