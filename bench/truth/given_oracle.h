#pragma once

#include "bench/truth/oracle.h"
#include "core/rays/ray_set.h"

#include <memory>
#include <span>

namespace tetrace {

/// Where the traced rays started: at the set's origins (given_quads), or offset, as BVHs get them (given_quads_offset).
enum class Origins { own, offset };

/// Judges the answers to given rays, as Oracle judges those to primary rays, by the set's own origins. The triangle
/// that a ray starts on is left out. For any-hit kinds, the triangle in the answer must be met before the ray's end.
class GivenOracle {
public:
    /// mesh: the scene's, kept by reference. threads: 0 is all.
    GivenOracle(const TriangleMesh& mesh, unsigned threads);
    ~GivenOracle();

    /// hits: by ray, in the set's order. Verdicts::flawed has pixels as in an image of the set's width. Keeps the exact
    /// answers for the last set, for the next row.
    [[nodiscard]] Verdicts judge(const RaySet& set, std::span<const Hit> hits, Origins origins,
                                 HitFormula formula = HitFormula::kernels);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tetrace
