#pragma once

#include "bench/truth/exact_ray.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// A curve near a ray that explains an answer: the corners of a polyline, relative to the ray's origin.
using Witness = std::vector<Double3>;

/// A question to a witness: does some curve within `bound` of the ray, which never goes back along it, meet `answer`
/// first?
struct WitnessQuestion {
    ExactRay ray;
    RayPart part;
    std::uint32_t answer = NO_HIT;            ///< a triangle, or NO_HIT: the curve meets none up to the end
    double bound = 0;                         ///< in domain units
    std::span<const std::uint32_t> obstacles; ///< all triangles near the ray, that of the answer too
};

/// Rounds a corner to what exact arithmetic takes: multiples of 2^-80, below 2^7.
[[nodiscard]] Double3 witness_corner(Double3 point);

/// Checks a witness by exact arithmetic. The curve starts at the ray's origin, or within the bound of it where the part
/// starts on a triangle. Its last segment passes through the interior of the answer's triangle and meets no other; the
/// other segments meet none. For NO_HIT no segment meets any, and the last corner is past all of them, or at the part's
/// end. A triangle that a segment touches counts as met.
[[nodiscard]] bool is_witness(const TriangleMesh& mesh, const WitnessQuestion& question, const Witness& witness);

/// Looks for a witness, in double precision, and checks what it finds; empty: none was found. Tries parallel rays
/// through all cells into which the edges of the obstacles divide the tube's cross-section, then polylines between
/// these cells. Where hundreds of edges lie within the bound it may overlook one.
[[nodiscard]] Witness find_witness(const TriangleMesh& mesh, const WitnessQuestion& question);

} // namespace tetrace
