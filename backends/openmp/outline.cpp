#include "backends/openmp/outline.h"

#include "core/base/vec.h"

#include <array>
#include <cmath>

namespace tetrace::openmp {

namespace {

/// Far more than rounding can move a ray, or the place where it meets a side of the domain (docs/spec/packets.md, K11).
constexpr double doubt = 0x1p-14;

using Place = std::array<double, 3>; // seen from the camera, by axis

Double3 to_double(const Place& a)
{
    return {a[0], a[1], a[2]};
}
double size_of(const Place& a)
{
    return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]);
}

/// The edge from p to q, which has the place `inside` on its inner side.
OutlineEdge edge_between(const Place& p, const Place& q, const Place& inside)
{
    const Double3 across = cross(to_double(p), to_double(q));
    const Double3 normal = across * (dot(to_double(inside), across) < 0 ? -1.0 : 1.0);
    return {{normal.x, normal.y, normal.z}, doubt * size_of(p) * size_of(q)};
}

} // namespace

void set_outline(PacketJob& job)
{
    const auto side = [&](unsigned axis, unsigned end) { // of the domain, seen from the camera
        return double{job.lines[axis * (job.divisions + 1) + end * job.divisions]} - job.origin[axis];
    };
    const auto is_seen = [&](unsigned axis, unsigned end) { return end != 0 ? side(axis, 1) < 0 : side(axis, 0) > 0; };
    job.outline_edges = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
        for (unsigned which = 0; which < 4; ++which) { // an edge along `axis`, at these ends of the two other axes
            const unsigned a = (axis + 1) % 3, b = (axis + 2) % 3, end_a = which & 1u, end_b = which >> 1;
            if (is_seen(a, end_a) == is_seen(b, end_b)) continue;
            Place p{}, q{}, opposite{};
            p[axis] = opposite[axis] = side(axis, 0);
            q[axis] = side(axis, 1);
            p[a] = q[a] = side(a, end_a);
            p[b] = q[b] = side(b, end_b);
            opposite[a] = side(a, 1 - end_a);
            opposite[b] = side(b, 1 - end_b);
            job.outline[job.outline_edges++] = edge_between(p, q, opposite);
        }
}

} // namespace tetrace::openmp
