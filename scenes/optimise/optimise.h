#pragma once

#include "core/base/progress.h"
#include "core/mesh/scene.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tetrace {

/// Expects how long the optimiser's rounds still take: gains of rounds, and their times, fall about geometrically.
class Forecast {
public:
    /// elapsed_s: since the first round began. gain: by which the round lowered the cost.
    void end_round(double elapsed_s, double gain);

    /// Seconds until a round gains less than `enough`, or `max_rounds` more are done.
    /// share_of_round: how much of the current one is done, in [0, 1].
    [[nodiscard]] double left_s(double elapsed_s, double share_of_round, double enough, std::uint32_t max_rounds) const;

private:
    double begin_s_ = 0;                         ///< of the current round
    double last_s_ = 0, last_gain_ = 0;          ///< of the last round; 0 before there is one
    double time_ratio_ = 0.6, gain_ratio_ = 0.3; ///< of a round to the one before; first those of bunny
};

/// How hard the optimiser tries: 0 leaves the tets unchanged, 3 is the maximum.
inline constexpr int max_effort = 3, default_effort = 2;

struct OptimiserLimits {
    int effort = default_effort;
    double time_limit_s = 0;                 ///< it ends after this much processor time of the process; 0: no limit
    const std::atomic<bool>* stop = nullptr; ///< it ends after the current operation where this becomes true
    int threads = 0;                         ///< 0: as many as OpenMP has. The result does not depend on it
    std::size_t tets_per_region = 12288; ///< at most (docs/spec/rays-tets.md, In parallel); the result depends on it
    bool several_pieces = false;         ///< of the mesh, or regions: then vertices are inserted with effort 2 too
    bool closed_too = false;             ///< whether the tets inside closed objects are changed, and cost, too
};

/// What an operation did.
struct OperationCount {
    std::string_view name;
    std::uint64_t done = 0;
    double gain = 0;    ///< free faces that a uniform line crosses fewer
    double seconds = 0; ///< of all threads together
};

/// Costs are the expected number of free faces that a uniform line crosses outside the objects, as if they let it
/// through: 2 (sum of the areas) / (area of the domain's boundary) (docs/spec/rays-tets.md). With closed_too: inside
/// them too.
struct OptimiserReport {
    double cost_before = 0, cost_after = 0;
    std::array<OperationCount, 5> operations; ///< edges removed, faces removed, vertices moved, collapsed, inserted
    std::uint32_t rounds = 0;
    OptimiserEnd end = OptimiserEnd::finished;
    double seconds = 0;
};

struct OptimisedTets {
    TetMesh mesh;
    OptimiserReport report;
};

/// Changes the tets that rays from outside reach so that these cross fewer faces: edges and faces are removed, vertices
/// moved, collapsed and inserted, each only where cost falls. Occlusive faces, the region of the domain and, without
/// closed_too, the tets inside closed objects stay; the sides of a box get other boundary faces. The same bits on every
/// machine and for any number of threads, unless it ends early; what it has is sound then too. Memory linear; time n
/// log n per round. mesh: sound (find_defect and find_gap find nothing); so is the result. progress: called by one
/// thread at a time, not always the same.
[[nodiscard]] OptimisedTets optimise(const TetMesh& mesh, const OptimiserLimits& limits, const Progress& progress);

} // namespace tetrace
