#pragma once

#include "bench/truth/box_tree.h"
#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// A ray in the coordinates of a mesh file: its numbers, float32 or float64, taken literally. It is the points
/// origin + t direction with t_min <= t <= t_max.
struct MeshRay {
    Double3 origin, direction;
    double t_min = 0, t_max = 0; ///< t_max may be infinite
};

/// Numbers of rays are 0, or of a magnitude from min_magnitude to max_magnitude: float64 then neither overflows nor
/// loses a denormal. Every float32 below max_magnitude is.
inline constexpr double min_magnitude = 0x1p-160, max_magnitude = 0x1p126;

/// Of a mesh's coordinates: rays from around it then are below max_magnitude.
inline constexpr double max_coordinate = 0x1p120;

/// The point at which a ray's line meets a triangle's plane: exact, then rounded to float64. u and v are the weights of
/// the triangle's second and third vertex.
struct PlanePoint {
    double t = 0, u = 0, v = 0;
};

/// What rays meet first, in exact arithmetic on a mesh of any coordinates: it is not placed, not scaled, and not
/// snapped to a grid as scenes are. Triangles are closed: a ray that passes through an edge or a vertex meets all
/// triangles that have it. A triangle whose plane the ray runs in is not met, nor is one without area. Double precision
/// decides what it can; the rest is decided with integers as long as it takes.
class NearestSearch {
public:
    /// mesh: kept by reference; its coordinates are at most max_coordinate.
    explicit NearestSearch(const TriangleMesh& mesh);

    /// All triangles at the least t of the ray, ascending; empty: it meets none. Several share an edge or a vertex that
    /// the ray passes through, or lie on each other there.
    [[nodiscard]] std::vector<std::uint32_t> nearest(const MeshRay& ray) const;

    /// Precondition: the ray's line meets the triangle, or at least its plane in one point.
    [[nodiscard]] PlanePoint point_of(const MeshRay& ray, std::uint32_t triangle) const;

    /// Whether a ray is parallel to a triangle's plane, or the triangle has no area.
    [[nodiscard]] bool sees_edge_on(const MeshRay& ray, std::uint32_t triangle) const;

    /// Whether a ray runs in a triangle's plane, and the point at which it meets `met` is a point of that triangle: a
    /// program may just as well name it.
    [[nodiscard]] bool holds_point_of(const MeshRay& ray, std::uint32_t edge_on, std::uint32_t met) const;

private:
    class Search;
    struct Exact;

    const TriangleMesh& mesh_;
    BoxTree tree_;
    int bits_; ///< every coordinate of the mesh is a multiple of 2^-bits_
};

} // namespace tetrace
