#include "scenes/builder/place.h"

#include "core/base/exact.h"

#include <algorithm>
#include <cmath>

namespace tetrace {
namespace {

TriangleMesh scaled(const TriangleMesh& mesh, int exponent, std::uint64_t& snapped)
{
    TriangleMesh result = mesh;
    snapped = 0;
    for (Float3& vertex : result.vertices) {
        for (int axis = 0; axis < 3; ++axis) {
            const double wanted = std::ldexp(static_cast<double>(vertex[axis]), exponent);
            vertex[axis] = snap_to_grid(static_cast<float>(wanted));
            if (static_cast<double>(vertex[axis]) != wanted) ++snapped;
        }
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
    Placement placement{safe_exponent(mesh), 0};
    TriangleMesh best = scaled(mesh, placement.scale_exponent, placement.snapped_coordinates);
    // Twice as large as long as it fits; the domain itself is rounded outwards, so ask for it each time.
    while (2 * reach(make_domain(best, kind, 1)) <= 1 + 0x1p-18f) {
        std::uint64_t snapped = 0;
        TriangleMesh larger = scaled(mesh, placement.scale_exponent + 1, snapped);
        if (reach(make_domain(larger, kind, 1)) > 1) break;
        best = std::move(larger);
        placement = {placement.scale_exponent + 1, snapped};
    }
    mesh = std::move(best);
    return placement;
}

} // namespace tetrace
