#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// Triangles with shared vertices: what a mesh reader returns and, placed in the domain, what rays hit.
struct TriangleMesh {
    std::vector<Float3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

/// The mesh's lowest and highest coordinates. Precondition: at least one vertex, all finite.
[[nodiscard]] std::array<Double3, 2> bounding_box(const TriangleMesh& mesh);

/// The sphere around the mesh's bounding box: its centre and half its diagonal. Camera distances and wide domains are
/// measured in its radius.
struct BoundingSphere {
    Double3 centre;
    double radius = 0;
};

/// Precondition: at least one vertex, all finite.
[[nodiscard]] BoundingSphere bounding_sphere(const TriangleMesh& mesh);

} // namespace tetrace
