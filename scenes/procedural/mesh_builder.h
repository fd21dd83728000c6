// procedural/: generators of meshes and scenes, one file each. Here: what they share. Only + - * / and square roots of
// doubles, and hashes of integers, so each mesh has the same bits on every machine.
#pragma once

#include "core/mesh/triangle_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

namespace tetrace {

/// Makes a mesh from points. Coordinates are rounded to multiples of 2^-16, and equal points become one vertex, so
/// parts that are made separately share their vertices where they meet.
class MeshBuilder {
public:
    std::uint32_t vertex(Double3 point);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh_.triangles.push_back({a, b, c}); }
    /// Two triangles with the diagonal from a to c.
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
    {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    void quad(const std::array<Double3, 4>& corners);
    /// The quads between two rows of equally many vertices. closed: the last vertices are joined with the first too.
    void strip(std::span<const std::uint32_t> from, std::span<const std::uint32_t> to, bool closed);
    /// The six sides of a box, two triangles each.
    void box(Double3 low, Double3 high);
    /// An octahedron with each edge cut in n, projected onto a sphere: 8 n^2 triangles, closed and wound outwards.
    /// height: factor of the radius in a direction of length 1.
    void sphere(Double3 centre, double radius, std::uint32_t n, const std::function<double(Double3)>& height);

    [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
    [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

private:
    struct HashPlace {
        std::size_t operator()(const std::array<std::int32_t, 3>& place) const;
    };
    TriangleMesh mesh_;
    std::unordered_map<std::array<std::int32_t, 3>, std::uint32_t, HashPlace> index_;
};

/// The n of the sphere with nearly this many triangles, at least 1.
[[nodiscard]] std::uint32_t sphere_edges(double triangles);

/// Fractal value noise in [0, 1]: random values on the points of a grid, interpolated smoothly between them; each
/// octave halves the grid's spacing, which is 1 in the first, and its weight.
[[nodiscard]] double fractal_noise(Double3 point, std::uint32_t octaves);

/// A random number in [0, 1), a multiple of 2^-24 that depends only on its counters.
[[nodiscard]] double random_unit(std::uint32_t stream, std::uint32_t counter);

} // namespace tetrace
