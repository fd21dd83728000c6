#include "bench/pictures/shading.h"

#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// The directions that a picture needs at every pixel, wide.
struct ViewFrame {
    Double3 corner, step_x, step_y, right, up;

    explicit ViewFrame(const View& view)
        : corner(to_double(view.corner)), step_x(to_double(view.step_x)), step_y(to_double(view.step_y)),
          right(normalized(step_x)), up(normalized(step_y * -1.0))
    {
    }
    [[nodiscard]] Double3 to_viewer(std::uint32_t x, std::uint32_t y) const
    {
        return normalized((corner + step_x * x + step_y * y) * -1.0);
    }
};

/// Unit normal of a triangle on the viewer's side; to_viewer itself for a triangle without area.
Double3 normal_towards(Double3 to_viewer, const TriangleMesh& mesh, std::uint32_t triangle)
{
    const auto [a, b, c] = mesh.triangles[triangle];
    const Double3 origin = to_double(mesh.vertices[a]);
    const Double3 normal = cross(to_double(mesh.vertices[b]) - origin, to_double(mesh.vertices[c]) - origin);
    const double size = length(normal);
    return size > 0.0 ? normal * ((dot(normal, to_viewer) < 0.0 ? -1.0 : 1.0) / size) : to_viewer;
}

Colour background(std::uint32_t y, std::uint32_t height)
{
    const Colour top = from_srgb(0xF7F9FB), bottom = from_srgb(0xCFD6DE);
    return mix(top, bottom, (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
}

/// Whether the ray of pixel (x, y) hit. Throws Error{internal} if it names no triangle of the mesh.
bool has_triangle(std::uint32_t face, std::uint32_t x, std::uint32_t y, const TriangleMesh& mesh)
{
    if (face == NO_HIT || face == LOST) return false;
    if (face >= mesh.triangles.size())
        throw Error(ErrorKind::internal, fmt::format("shading pixel ({}, {}): the hit names face {}, but the mesh has "
                                                     "{} triangles",
                                                     x, y, face, mesh.triangles.size()));
    return true;
}

} // namespace

Colour shade(Double3 normal, Double3 to_viewer, Double3 right, Double3 up)
{
    const Colour clay = from_srgb(0xE0BE9C), sky = from_srgb(0xA9BFDA), ground = from_srgb(0x6E5B4E);
    const Double3 light = normalized(to_viewer + up * 0.55 - right * 0.45);
    const Double3 half_way = normalized(light + to_viewer);
    const auto diffuse = static_cast<float>(std::max(0.0, dot(normal, light)));
    const auto gloss = static_cast<float>(std::pow(std::max(0.0, dot(normal, half_way)), 40.0));
    const Colour ambient = mix(ground, sky, static_cast<float>(0.5 + 0.5 * dot(normal, up)));
    const Colour lit = ambient * 0.55f + Colour{1.0f, 0.97f, 0.92f} * (0.95f * diffuse * diffuse);
    return Colour{clay.r * lit.r, clay.g * lit.g, clay.b * lit.b} + Colour{1.0f, 1.0f, 1.0f} * (0.06f * gloss);
}

Pixmap shade_hits(std::span<const Hit> hits, const View& view, std::uint32_t width, std::uint32_t height,
                  const TriangleMesh& mesh)
{
    const ViewFrame frame(view);
    Pixmap pixmap(width, height);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t face = hits[std::size_t{y} * width + x].face_id;
            if (!has_triangle(face, x, y, mesh)) {
                pixmap.at(x, y) = face == LOST ? lost_colour() : background(y, height);
                continue;
            }
            const Double3 to_viewer = frame.to_viewer(x, y);
            pixmap.at(x, y) = shade(normal_towards(to_viewer, mesh, face), to_viewer, frame.right, frame.up);
        }
    }
    return pixmap;
}

HitLayers layers_of_hits(std::span<const Hit> hits, const View& view, std::uint32_t width, std::uint32_t height,
                         const TriangleMesh& mesh)
{
    const ViewFrame frame(view);
    HitLayers layers{width, height, {}};
    layers.pixels.reserve(hits.size());
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const Hit& hit = hits[std::size_t{y} * width + x];
            const Double3 normal = has_triangle(hit.face_id, x, y, mesh)
                                       ? normal_towards(frame.to_viewer(x, y), mesh, hit.face_id)
                                       : Double3{};
            layers.pixels.push_back({hit.t, hit.steps, to_float(normal), hit.face_id});
        }
    }
    return layers;
}

} // namespace tetrace
