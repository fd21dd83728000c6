#pragma once

#include "bench/truth/box_tree.h"
#include "bench/truth/exact_ray.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// What a ray meets first.
struct FirstHit {
    std::uint32_t face = NO_HIT;
    bool is_clear = true; ///< nothing but that triangle is within the radius of the ray up to it, and no edge of it;
                          ///< otherwise `face` says nothing
};

/// A search for triangles by exact arithmetic, which shares nothing with the kernels or Embree: a tree of boxes that
/// are grown outwards, and leaf tests in double precision whose rounding errors are bounded. What they cannot decide
/// is not clear.
class ExactSearch {
public:
    /// mesh: kept by reference; its coordinates are on the grid of core/base/exact.h.
    explicit ExactSearch(const TriangleMesh& mesh) : mesh_(mesh), tree_(mesh) {}

    /// The first triangle that the part of the ray meets. radius: in domain units, at least tie_bound().
    [[nodiscard]] FirstHit first(const ExactRay& ray, const RayPart& part, double radius) const;

    /// All triangles within the radius of the ray up to its end, ascending, and maybe some that are not; without the
    /// one that the part starts on.
    [[nodiscard]] std::vector<std::uint32_t> within(const ExactRay& ray, const RayPart& part, double radius) const;

private:
    struct Tube;
    class Nearest;

    template <class Visit>
    void visit(const Tube& tube, const Visit& visit) const;

    const TriangleMesh& mesh_;
    BoxTree tree_;
};

} // namespace tetrace
