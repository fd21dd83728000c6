#pragma once

#include "bench/pictures/hit_layers.h"
#include "bench/pictures/pixmap.h"
#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"

#include <span>

namespace tetrace {

/// The colour of a surface under a light above the camera, a soft sky above and ground below, by the normal of the
/// input triangle, turned towards the viewer. normal and to_viewer: unit length, in scene units; right, up: of the
/// camera.
[[nodiscard]] Colour shade(Double3 normal, Double3 to_viewer, Double3 right, Double3 up);

/// The picture of a view: hits shaded by their triangles' normals, misses as a light background, lost rays in magenta.
/// hits: width * height, row after row. Throws Error{internal} naming the pixel where a hit names no triangle of the
/// mesh, or was never written.
[[nodiscard]] Pixmap shade_hits(std::span<const Hit> hits, const View& view, std::uint32_t width, std::uint32_t height,
                                const TriangleMesh& mesh);

/// The hits of a view, each with the normal of its triangle; to_viewer for a triangle without area. Throws as
/// shade_hits() does.
[[nodiscard]] HitLayers layers_of_hits(std::span<const Hit> hits, const View& view, std::uint32_t width,
                                       std::uint32_t height, const TriangleMesh& mesh);

} // namespace tetrace
