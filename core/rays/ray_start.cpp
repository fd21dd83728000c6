#include "core/rays/ray_start.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/mesh/tet_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tetrace {

namespace {

float offset_coordinate(float coordinate, float normal)
{
    constexpr float near_zero = 1.0F / 32, scale = 1.0F / 65536, units = 256;
    if (std::abs(coordinate) < near_zero) return coordinate + scale * normal;
    const auto steps = static_cast<std::int32_t>(units * normal);
    const std::int32_t bits = std::bit_cast<std::int32_t>(coordinate) + (coordinate < 0 ? -steps : steps);
    return std::bit_cast<float>(bits);
}

} // namespace

Float3 offset_point(Float3 point, Float3 normal)
{
    return snap_to_grid(Float3{offset_coordinate(point.x, normal.x), offset_coordinate(point.y, normal.y),
                               offset_coordinate(point.z, normal.z)});
}

Float3 offset_origin(const GivenRay& ray, const TriangleMesh& mesh)
{
    if (ray.triangle == FREE_FACE) return ray.origin;
    const auto& [a, b, c] = mesh.triangles.at(ray.triangle);
    const Double3 v0 = to_double(mesh.vertices[a]);
    const Double3 normal = normalized(cross(to_double(mesh.vertices[b]) - v0, to_double(mesh.vertices[c]) - v0));
    const double side = dot(normal, to_double(ray.direction)) < 0 ? -1 : 1;
    return offset_point(ray.origin, to_float(normal * side));
}

namespace {

constexpr double crossing_margin = 0x1p-19;

using FaceCorners = std::array<Double3, 3>;

FaceCorners corners_of_face(const TetMesh& mesh, std::uint32_t tet, std::uint32_t face)
{
    FaceCorners corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = to_double(mesh.vertices[mesh.tets[tet].vertices[face_corners[face][i]]]);
    return corners;
}

Double3 normal_of(const FaceCorners& corners)
{
    return normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

// Distance of a point of the face's plane from the nearest line through an edge; negative outside the face.
double depth_in(const FaceCorners& corners, Double3 normal, Double3 point)
{
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 inwards = cross(normal, normalized(corners[(i + 1) % 3] - corners[i]));
        least = std::min(least, dot(inwards, point - corners[i]));
    }
    return least;
}

struct Circle {
    Double3 centre;
    double radius;
};

Circle inscribed_circle(const FaceCorners& corners)
{
    const double a = length(corners[2] - corners[1]), b = length(corners[0] - corners[2]),
                 c = length(corners[1] - corners[0]);
    const double around = a + b + c;
    const double twice_area = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return {(corners[0] * a + corners[1] * b + corners[2] * c) * (1 / around), twice_area / around};
}

// Distances from the edges change linearly on the way to the centre, where each is the circle's radius.
Double3 moved_inside(const FaceCorners& corners, Double3 normal, Double3 point)
{
    const double depth = depth_in(corners, normal, point);
    if (depth >= edge_margin) return point;
    const Circle circle = inscribed_circle(corners);
    const double share = circle.radius > edge_margin ? (edge_margin - depth) / (circle.radius - depth) : 1.0;
    return point + (circle.centre - point) * share;
}

Double3 hit_point(const TriangleMesh& mesh, const Hit& hit)
{
    const auto& [a, b, c] = mesh.triangles.at(hit.face_id);
    const Double3 v0 = to_double(mesh.vertices[a]);
    return v0 + (to_double(mesh.vertices[b]) - v0) * static_cast<double>(hit.u) +
           (to_double(mesh.vertices[c]) - v0) * static_cast<double>(hit.v);
}

} // namespace

RayStart ray_start(const Scene& scene, const Hit& hit)
{
    const Double3 point = hit_point(scene.mesh, hit);
    const Tet& tet = scene.tets.tets.at(hit.tet);
    RayStart start{{}, NO_HALF_FACE, {}, {}};
    double most = -HUGE_VAL;
    for (std::uint32_t face = 0; face < 4; ++face) {
        if (tet.faces[face] != hit.face_id) continue; // a triangle may have two pieces in a nearly flat tet
        const FaceCorners corners = corners_of_face(scene.tets, hit.tet, face);
        const Double3 inward = normal_of(corners);
        const double depth = depth_in(corners, inward, point);
        if (start.half_face != NO_HALF_FACE && depth <= most) continue;
        most = depth;
        start = {{}, make_half_face(hit.tet, face), inward, corners};
    }
    if (start.half_face == NO_HALF_FACE)
        throw Error(ErrorKind::internal, "making rays: tet " + std::to_string(hit.tet) + " lacks a face of triangle " +
                                             std::to_string(hit.face_id) + " that it was hit on");
    start.origin = snap_to_grid(to_float(moved_inside(start.corners, start.inward, point)));
    return start;
}

RayStart ray_start(const TriangleMesh& mesh, const Hit& hit, Float3 direction)
{
    RayStart start{{}, NO_HALF_FACE, {}, {}};
    for (std::size_t i = 0; i < 3; ++i)
        start.corners[i] = to_double(mesh.vertices[mesh.triangles.at(hit.face_id)[i]]);
    if (dot(normal_of(start.corners), to_double(direction)) > 0) std::swap(start.corners[1], start.corners[2]);
    start.inward = normal_of(start.corners);
    start.origin = snap_to_grid(to_float(moved_inside(start.corners, start.inward, hit_point(mesh, hit))));
    return start;
}

bool enters(const RayStart& start, Float3 direction)
{
    const Double3 along = to_double(direction);
    const double rise = dot(start.inward, along);
    if (!(rise >= min_sine * length(along)) || rise == 0) return false;
    const Double3 origin = to_double(start.origin);
    const double back = dot(start.inward, start.corners[0] - origin) / rise;
    return depth_in(start.corners, start.inward, origin + along * back) >= crossing_margin;
}

std::uint32_t face_behind(const TetMesh& mesh, std::uint32_t tet, Float3 origin, Float3 direction)
{
    const Double3 along = to_double(direction);
    std::uint32_t best = 0;
    double most = -HUGE_VAL;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const FaceCorners corners = corners_of_face(mesh, tet, face);
        const Double3 inward = normal_of(corners);
        const double rise = dot(inward, along);
        if (rise <= 0) continue;
        const double back = dot(inward, corners[0] - to_double(origin)) / rise;
        const double depth = depth_in(corners, inward, to_double(origin) + along * back);
        if (depth > most) {
            most = depth;
            best = face;
        }
    }
    return best;
}

} // namespace tetrace
