#pragma once

#include "core/mesh/scene.h"

#include <functional>
#include <optional>

namespace tetrace {

/// The tet that holds a point, by exact orientation tests (a visibility walk; Devillers, Pion, Teillaud 2002).
/// point: coordinates on the 2^-40 grid. Tets are closed: a point on a face, edge or vertex gets any tet that has it.
/// NO_TET if the point is outside the domain.
[[nodiscard]] std::uint32_t locate(const TetMesh& mesh, Float3 point);

/// How a walk from one tet to that of a point ended.
struct WalkEnd {
    enum class Kind {
        arrived, ///< in a tet that holds the point
        outside, ///< the point is outside the domain
        too_far, ///< after as many steps as it may take
    };
    Kind kind = Kind::too_far;
    std::uint32_t tet = NO_TET; ///< where it arrived, else NO_TET
    std::uint32_t steps = 0;    ///< from tet to tet
};

/// The same walk from a given tet, which is short where the tet is near the point. Each step crosses a face that
/// separates its tet from the point, by exact orientation tests.
/// from: a tet of the mesh. max_steps: it gives up rather than take more.
[[nodiscard]] WalkEnd walk_to(const TetMesh& mesh, std::uint32_t from, Float3 point, std::uint32_t max_steps);

/// Where the rays of a view start.
struct Start {
    Float3 origin;              ///< the camera's origin, or a point near it
    std::uint32_t tet = NO_TET; ///< holds the origin in its interior; NO_TET: outside, rays enter by the entry grid

    friend bool operator==(const Start&, const Start&) = default;
};

/// Whether the tet holds the start's origin in its interior, so that no other tet does.
[[nodiscard]] bool is_inside(const Scene& scene, const Start& start);

/// Finds a tet that holds a point in the domain; NO_TET if it finds none.
using Locator = std::function<std::uint32_t(Float3)>;

/// Locates a camera. A camera nearer than 2^-16 to a face of its tet is within the rounding of a walk's decisions. It
/// moves by at most 2^-12 in each coordinate, to the candidate with the most clearance. All structures trace from the
/// moved origin. Not for a scene without tets.
[[nodiscard]] Start find_start(const Scene& scene, Float3 origin);
/// The same by another way to find tets. The result does not depend on which of the tets that hold a point the locator
/// names, as long as is_inside() says yes to it.
[[nodiscard]] Start find_start(const Scene& scene, Float3 origin, const Locator& locator);

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
