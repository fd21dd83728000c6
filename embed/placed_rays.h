#pragma once

#include "core/base/vec.h"
#include "core/mesh/scene.h"
#include "core/rays/hit.h"
#include "core/rays/ray_set.h"
#include "embed/include/tetrace/tetrace.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tetrace {

/// The caller's rays in the coordinates that kernels need, and the way back for their hits.
///
/// A mesh was moved and scaled by a power of two, so rays are too. A ray begins at the float that is nearest to origin
/// + t_min * direction, on the 2^-40 grid; one that begins more than 32 units from the domain's centre begins where it
/// comes near. Directions are scaled by a power of two, and their components below 2^-20 of the largest are 0.
class PlacedRays {
public:
    /// Throws Error{usage} naming the first ray that is not finite, has a negative or no t_min, or no direction.
    /// structure: rays through tets that begin in one are located on the host. first_number: that of the first ray, for
    /// messages. threads: of the host.
    PlacedRays(const Scene& scene, Structure structure, std::span<const tetrace_ray> rays, std::size_t first_number,
               unsigned threads);

    /// As many as a launch needs: a multiple of TILE_WIDTH, those in addition repeat the last one.
    [[nodiscard]] const RaySet& set() const { return set_; }

    /// The hit of a ray of the caller's, in the caller's terms. Throws Error{wrong_result} for a walk that was lost.
    [[nodiscard]] tetrace_hit hit_of(std::size_t ray, const Hit& hit) const;

private:
    /// t = shift + scale * Hit::t.
    struct Way {
        double shift = 0, scale = 1;
        bool is_empty = false; ///< whether the ray ends before it begins, or passes far from the domain
    };
    [[nodiscard]] GivenRay placed(const tetrace_ray& ray, Way& way) const;
    void locate_starts(unsigned threads);

    const Scene* scene_;
    std::span<const tetrace_ray> rays_;
    std::size_t first_number_;
    RaySet set_;
    std::vector<Way> ways_;
};

} // namespace tetrace
