#pragma once

#include "bench/truth/oracle.h"
#include "core/rays/ray_set.h"

#include <memory>
#include <span>

namespace tetrace {

/// Where the rays that were traced started: where the set has them (given_quads), or offset, as BVHs get them
/// (given_quads_offset).
enum class Origins { own, offset };

/// Judges the answers to rays that were given, as Oracle does those to primary ones. Embree gets the set's own origins
/// and is asked on behind the triangle that a ray starts on. Of kinds that take any hit, whether there is one is
/// compared, and a triangle that was named must be met before the ray's end.
class GivenOracle {
public:
    /// mesh: the scene's, kept by reference. threads: 0 is all.
    GivenOracle(const TriangleMesh& mesh, unsigned threads);
    ~GivenOracle();

    /// hits: by ray, in the set's order. Verdicts::flawed has pixels as in an image of the set's width. Keeps Embree's
    /// answers to the last set for the next row.
    [[nodiscard]] Verdicts judge(const RaySet& set, std::span<const Hit> hits, Origins origins);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tetrace
