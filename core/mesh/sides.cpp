#include "core/mesh/sides.h"

#include "core/base/exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace tetrace {

namespace {

constexpr double camera_radii = 3; // core/rays/camera_set.h: the farthest is 2.9 away; core/rays/aim.h: own ones 3
constexpr double bounds_needed = 3;

double min_distance(const Scene& scene)
{
    const BoundingSphere sphere = bounding_sphere(scene.mesh);
    const double in_domain = std::sqrt(3.0);
    const double farthest = std::max(in_domain, length(sphere.centre) + camera_radii * sphere.radius);
    return bounds_needed * tie_bound({static_cast<float>(farthest), 0, 0});
}

std::string side_name(int axis, bool is_high)
{
    return std::string(is_high ? "high " : "low ") + "xyz"[axis] + " side";
}

/// The least of a triangle's three heights.
double height_of(const std::array<Double3, 3>& corners)
{
    const Double3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
    return length(cross(ab, ac)) / std::max({length(ab), length(ac), length(bc)});
}

double height_of(const TetMesh& mesh, std::uint32_t half_face)
{
    std::array<Double3, 3> corners;
    for (std::uint32_t i = 0, n = 0; i < 4; ++i)
        if (i != half_face_index(half_face))
            corners[n++] = to_double(mesh.vertices[mesh.tets[half_face_tet(half_face)].vertices[i]]);
    return height_of(corners);
}

std::string domain_too_large(const Domain& domain)
{
    for (int axis = 0; axis < 3; ++axis)
        if (domain.low()[axis] < -1 || domain.high()[axis] > 1)
            return std::string("the domain exceeds [-1, 1] along axis ") + "xyz"[axis] +
                   "; scale mesh and domain by a power of two";
    return "";
}

std::string mesh_too_near(const Scene& scene, double needed)
{
    for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool is_high : {false, true}) {
                const auto at = static_cast<double>(scene.mesh.vertices[i][axis]);
                const double distance = is_high ? static_cast<double>(scene.domain.high()[axis]) - at
                                                : at - static_cast<double>(scene.domain.low()[axis]);
                if (distance >= needed) continue;
                std::ostringstream text;
                text << "vertex " << i << " of the mesh is " << distance << " away from the domain's "
                     << side_name(axis, is_high) << ", rounding asks for " << needed << "; use a larger domain";
                return text.str();
            }
    return "";
}

std::string face_too_thin(const Scene& scene, const EntryGrid& grid, double needed)
{
    for (std::uint32_t side = 0; side < 6; ++side)
        for (const std::uint32_t half_face : faces_of_side(grid, side)) {
            const double height = height_of(scene.tets, half_face);
            if (height >= needed) continue;
            std::ostringstream text;
            text << "a boundary face of tet " << half_face_tet(half_face) << ", on the domain's "
                 << side_name(static_cast<int>(side / 2), side % 2 == 1) << ", has a height of " << height
                 << ", rounding asks for " << needed << "; use fewer divisions, or tets without such a face";
            return text.str();
        }
    return "";
}

} // namespace

std::string find_weak_side(const Scene& scene, const EntryGrid& grid)
{
    std::string found = domain_too_large(scene.domain);
    const double needed = min_distance(scene);
    if (found.empty()) found = mesh_too_near(scene, needed);
    if (found.empty()) found = face_too_thin(scene, grid, needed);
    return found;
}

} // namespace tetrace
