#pragma once

#include "core/mesh/locate.h"

#include <optional>

namespace tetrace {

/// When a camera's new tet is looked for from its old one. Past either limit it is located exactly.
struct MoveLimit {
    double distance;     ///< of the camera's move, in domain units
    std::uint32_t steps; ///< from tet to tet
};
/// A quarter of the domain's longest side, and 4,096 tets.
[[nodiscard]] MoveLimit usual_move_limit(const Domain& domain);

/// What a moving camera's starts took.
struct MoveCounts {
    std::uint32_t walked = 0;    ///< starts found by walking from the one before
    std::uint32_t located = 0;   ///< starts found by exact location: the first, those after one outside or too far off
    std::uint64_t steps = 0;     ///< from tet to tet, of all walks, also of those that gave up
    std::uint32_t max_steps = 0; ///< of a single walk
};

/// The starts of a camera that moves from view to view. The tet of a new position is found by walking from that of the
/// position before, over a limited distance. Each start is the one that find_start() gives.
/// Source: the paper (GRAPP 2017), section 2.3.1.
class MovingStart {
public:
    /// scene: outlives this object.
    MovingStart(const Scene& scene, MoveLimit limit) : scene_(&scene), limit_(limit) {}

    /// The start of the camera's next position.
    [[nodiscard]] Start next(Float3 origin);

    [[nodiscard]] const MoveCounts& counts() const { return counts_; }

private:
    [[nodiscard]] bool is_near(Float3 point) const;
    /// The start by walking from the last one's tet; empty if a walk gives up.
    [[nodiscard]] std::optional<Start> walk(Float3 origin);

    const Scene* scene_;
    MoveLimit limit_;
    Start last_;
    MoveCounts counts_;
};

} // namespace tetrace
