#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>

namespace tetrace {

/// How a mesh came into domain units.
struct Placement {
    int scale_exponent = 0;                ///< domain units = mesh units * 2^scale_exponent
    std::uint64_t snapped_coordinates = 0; ///< coordinates that the 2^-40 grid rounded; every other one is exact
};

/// Scales a mesh by a power of two, so that its domain is in [-1, 1]^3 and exceeds 1/2, and rounds coordinates to the
/// grid of core/base/exact.h. No translation. The mesh has at least one vertex, all finite.
Placement place(TriangleMesh& mesh, DomainKind kind);

} // namespace tetrace
