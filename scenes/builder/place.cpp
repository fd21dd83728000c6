#include "core/base/exact.h"
#include "scenes/builder/build.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

TriangleMesh scaled(const TriangleMesh& mesh, Placement& placement)
{
    TriangleMesh result = mesh;
    placement.snapped_coordinates = 0;
    placement.moved = 0;
    for (Float3& vertex : result.vertices) {
        Double3 change{};
        for (int axis = 0; axis < 3; ++axis) {
            const double wanted = std::ldexp(static_cast<double>(vertex[axis]), placement.scale_exponent);
            vertex[axis] = snap_to_grid(static_cast<float>(wanted));
            const double by = wanted - static_cast<double>(vertex[axis]);
            (axis == 0 ? change.x : axis == 1 ? change.y : change.z) = by;
            if (by != 0) ++placement.snapped_coordinates;
        }
        placement.moved = std::max(placement.moved, std::ldexp(length(change), -placement.scale_exponent));
    }
    return result;
}

float reach(const Domain& domain)
{
    float most = 0;
    for (int axis = 0; axis < 3; ++axis)
        most = std::max({most, -domain.low()[axis], domain.high()[axis]});
    return most;
}

// An exponent that surely fits: coordinates times 8 (a wide domain reaches 3 sqrt(3) half-extents, and the centre) stay
// below 1.
int safe_exponent(const TriangleMesh& mesh)
{
    float most = 0;
    for (const Float3 v : mesh.vertices)
        most = std::max({most, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    int exponent = 0;
    std::frexp(most, &exponent);
    return -exponent - 3;
}

} // namespace

Placement place(TriangleMesh& mesh, DomainKind kind)
{
    Placement placement{safe_exponent(mesh)};
    TriangleMesh best = scaled(mesh, placement);
    // Twice as large as long as it fits; the domain itself is rounded outwards, so ask for it each time.
    while (2 * reach(make_domain(best, kind, 1)) <= 1 + 0x1p-18f) {
        Placement next{placement.scale_exponent + 1};
        TriangleMesh larger = scaled(mesh, next);
        if (reach(make_domain(larger, kind, 1)) > 1) break;
        best = std::move(larger);
        placement = next;
    }
    mesh = std::move(best);
    return placement;
}

} // namespace tetrace
