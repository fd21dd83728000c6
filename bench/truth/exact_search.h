#pragma once

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
    explicit ExactSearch(const TriangleMesh& mesh);

    /// The first triangle that the part of the ray meets. radius: in domain units, at least tie_bound().
    [[nodiscard]] FirstHit first(const ExactRay& ray, const RayPart& part, double radius) const;

    /// All triangles within the radius of the ray up to its end, ascending, and maybe some that are not; without the
    /// one that the part starts on.
    [[nodiscard]] std::vector<std::uint32_t> within(const ExactRay& ray, const RayPart& part, double radius) const;

private:
    struct Node {
        float low[3], high[3];
        std::uint32_t first = 0; ///< of its triangles in order_, or of its two children
        std::uint32_t count = 0; ///< triangles; 0: it has children
    };
    struct Builder;
    struct Tube;
    class Nearest;

    template <class Visit>
    void visit(Tube& tube, const Visit& visit) const;

    const TriangleMesh& mesh_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

} // namespace tetrace
