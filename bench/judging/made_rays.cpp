#include "bench/judging/made_rays.h"

#include "core/base/error.h"
#include "core/base/random_words.h"
#include "core/rays/camera.h"
#include "core/rays/camera_set.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace tetrace {

namespace {

constexpr float no_end = std::numeric_limits<float>::infinity();
constexpr std::uint32_t stream_of_words = 105, stream_of_directions = 106;

/// Random numbers of one ray, one after the other.
class RayDraws {
public:
    explicit RayDraws(std::uint64_t number)
        : low_(static_cast<std::uint32_t>(number)), high_(static_cast<std::uint32_t>(number >> 32))
    {
    }
    std::uint32_t below(std::size_t limit) { return static_cast<std::uint32_t>(std::uint64_t{word()} * limit >> 32); }
    double unit() { return (word() + 0.5) * 0x1p-32; }
    Double3 direction() { return random_direction({stream_of_directions, low_, high_, next_++}); }

private:
    std::uint32_t word() { return random_words({low_, high_, next_++, 0}, stream_of_words)[0]; }

    std::uint32_t low_, high_, next_ = 0;
};

RayNumbers ray_numbers(Float3 origin, Float3 direction, float t_min = 0, float t_max = no_end)
{
    return {origin.x, origin.y, origin.z, t_min, direction.x, direction.y, direction.z, t_max};
}

std::vector<RayNumbers> primary_rays(const TriangleMesh& mesh, std::uint64_t count)
{
    const auto cameras = make_cameras(CameraSet::frame, mesh);
    const auto side = static_cast<std::uint32_t>(
        std::ceil(std::sqrt(static_cast<double>(count) / static_cast<double>(cameras.size()))));
    std::vector<RayNumbers> rays;
    for (const Camera& camera : cameras) {
        const View view = make_view(camera, side, side);
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side && rays.size() < count; ++x)
                rays.push_back(ray_numbers(view.origin, to_float(to_double(view.corner) + to_double(view.step_x) * x +
                                                                 to_double(view.step_y) * y)));
    }
    return rays;
}

RayNumbers random_ray(const BoundingSphere& sphere, std::uint64_t number)
{
    RayDraws draws(number);
    const Double3 along = draws.direction();
    Double3 across = draws.direction();
    across = normalized(across - along * dot(across, along)) * (sphere.radius * std::sqrt(draws.unit()));
    return ray_numbers(to_float(sphere.centre + across - along * (2 * sphere.radius)), to_float(along));
}

/// What rays of kind `hard` are made to meet, or to pass exactly.
enum class HardRay {
    at_vertex,
    through_vertex, ///< along an axis, exactly
    at_edge,
    along_edge,
    in_plane, ///< from a corner of a triangle through the opposite edge
    vertex_to_vertex,
    from_face,
    grazing,
    at_thin,
    to_end, ///< it ends, or begins, at a vertex
};
constexpr std::uint64_t kinds_of_hard_rays = 10;

class HardMeshRays {
public:
    explicit HardMeshRays(const TriangleMesh& mesh) : mesh_(mesh), sphere_(bounding_sphere(mesh)), thinnest_(thinnest())
    {
    }

    [[nodiscard]] RayNumbers ray(std::uint64_t number) const
    {
        RayDraws draws(number);
        const Corners corners = corners_of(draws.below(mesh_.triangles.size()), draws);
        const auto& [a, b, c] = corners;
        switch (static_cast<HardRay>(number % kinds_of_hard_rays)) {
        case HardRay::at_vertex: return from_outside(draws, a);
        case HardRay::through_vertex: return along_axis(draws, to_float(a));
        case HardRay::at_edge: return from_outside(draws, on_edge(draws, a, b));
        case HardRay::along_edge: return moved_back(a, b - a);
        case HardRay::in_plane: return moved_back(a, on_edge(draws, b, c) - a);
        case HardRay::vertex_to_vertex: return vertex_to_vertex(draws, a);
        case HardRay::from_face: return from_face(draws, corners);
        case HardRay::grazing: return grazing(draws, corners);
        case HardRay::at_thin:
            return from_outside(draws, inside(draws, corners_of(thinnest_[draws.below(thinnest_.size())], draws)));
        case HardRay::to_end: return to_end(draws, a);
        }
        return {};
    }

private:
    using Corners = std::array<Double3, 3>;

    [[nodiscard]] Corners corners_of(std::uint32_t triangle, RayDraws& draws) const
    {
        const auto& vertices = mesh_.triangles[triangle];
        const std::uint32_t first = draws.below(3);
        const auto corner = [&](std::uint32_t i) { return to_double(mesh_.vertices[vertices[(first + i) % 3]]); };
        return {corner(0), corner(1), corner(2)};
    }

    /// One in 64 triangles: those that are the least high for their length.
    [[nodiscard]] std::vector<std::uint32_t> thinnest() const
    {
        std::vector<std::pair<double, std::uint32_t>> heights;
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            const auto& [p, q, r] = mesh_.triangles[i];
            const Double3 a = to_double(mesh_.vertices[p]), b = to_double(mesh_.vertices[q]),
                          c = to_double(mesh_.vertices[r]);
            const double longest = std::max({length(b - a), length(c - b), length(a - c)});
            heights.emplace_back(longest > 0 ? length(cross(b - a, c - a)) / (longest * longest) : 0, i);
        }
        const auto kept = static_cast<std::ptrdiff_t>(heights.size() / 64 + 1);
        std::partial_sort(heights.begin(), heights.begin() + kept, heights.end());
        std::vector<std::uint32_t> triangles;
        for (std::ptrdiff_t i = 0; i < kept; ++i)
            triangles.push_back(heights[static_cast<std::size_t>(i)].second);
        return triangles;
    }

    static Double3 on_edge(RayDraws& draws, Double3 a, Double3 b)
    {
        return a + (b - a) * (draws.below(2) == 0 ? 0.5 : draws.unit());
    }
    static Double3 inside(RayDraws& draws, const Corners& corners)
    {
        const double u = draws.unit(), v = draws.unit() * (1 - u);
        return corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
    }
    [[nodiscard]] Double3 outside(RayDraws& draws) const
    {
        const Double3 direction = draws.direction();
        return sphere_.centre + direction * (sphere_.radius * (1.5 + draws.unit()));
    }

    /// The direction is rounded after the origin; a zero direction is replaced.
    [[nodiscard]] static RayNumbers towards(Float3 origin, Double3 target, float t_min = 0, float t_max = no_end)
    {
        const Float3 direction = to_float(target - to_double(origin));
        return ray_numbers(origin, direction == Float3{} ? Float3{1, 0, 0} : direction, t_min, t_max);
    }
    [[nodiscard]] RayNumbers from_outside(RayDraws& draws, Double3 target) const
    {
        return towards(to_float(outside(draws)), target);
    }
    [[nodiscard]] RayNumbers along_axis(RayDraws& draws, Float3 vertex) const
    {
        const auto axis = static_cast<int>(draws.below(3));
        const float sense = draws.below(2) == 0 ? 1 : -1;
        Float3 direction;
        direction[axis] = sense;
        vertex[axis] -= sense * static_cast<float>(2 * sphere_.radius);
        return ray_numbers(vertex, direction);
    }
    /// Along a line, from outside the mesh: by a power of two, which mostly keeps it exact.
    [[nodiscard]] RayNumbers moved_back(Double3 from, Double3 along) const
    {
        if (!(length(along) > 0)) along = {1, 0, 0};
        const Float3 direction = to_float(along);
        double by = 1;
        while (by * length(along) < 2 * sphere_.radius && by < 0x1p60)
            by *= 2;
        return ray_numbers(to_float(from - to_double(direction) * by), direction);
    }
    [[nodiscard]] RayNumbers vertex_to_vertex(RayDraws& draws, Double3 from) const
    {
        const Corners other = corners_of(draws.below(mesh_.triangles.size()), draws);
        const float t_min = draws.below(2) == 0 ? 0x1p-10f : 0;
        return towards(to_float(from), other[0], t_min, draws.below(2) == 0 ? 1 : no_end);
    }
    [[nodiscard]] RayNumbers from_face(RayDraws& draws, const Corners& corners) const
    {
        const Float3 origin = to_float(inside(draws, corners));
        const Corners other = corners_of(draws.below(mesh_.triangles.size()), draws);
        return towards(origin, draws.below(2) == 0 ? inside(draws, other) : to_double(origin) + draws.direction());
    }
    [[nodiscard]] RayNumbers grazing(RayDraws& draws, const Corners& corners) const
    {
        const Double3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const Double3 in_face = inside(draws, corners) - corners[0];
        const double tilt = std::ldexp(1.0, -4 - static_cast<int>(draws.below(24)));
        const Double3 way = length(normal) > 0 && length(in_face) > 0 ? normalized(in_face) - normalized(normal) * tilt
                                                                      : draws.direction();
        return moved_back(inside(draws, corners), way);
    }
    [[nodiscard]] RayNumbers to_end(RayDraws& draws, Double3 vertex) const
    {
        const bool begins = draws.below(2) == 0;
        return towards(to_float(outside(draws)), vertex, begins ? 1 : 0, begins ? no_end : 1);
    }

    const TriangleMesh& mesh_;
    BoundingSphere sphere_;
    std::vector<std::uint32_t> thinnest_;
};

} // namespace

std::vector<RayNumbers> make_mesh_rays(MadeRays kind, const TriangleMesh& mesh, std::uint64_t count)
{
    constexpr double min_radius = 0x1p-20; // cameras are on the grid of core/base/exact.h
    const BoundingSphere sphere = bounding_sphere(mesh);
    if (sphere.radius < min_radius)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("making rays: the mesh's bounding sphere has a radius of {:.2g}, and at least 2^-20 is "
                                "needed; scale the mesh up",
                                sphere.radius));
    if (kind == MadeRays::primary) return primary_rays(mesh, count);
    std::vector<RayNumbers> rays(count);
    if (kind == MadeRays::random) {
        for (std::uint64_t i = 0; i < count; ++i)
            rays[i] = random_ray(sphere, i);
        return rays;
    }
    const HardMeshRays hard(mesh);
    for (std::uint64_t i = 0; i < count; ++i)
        rays[i] = hard.ray(i);
    return rays;
}

} // namespace tetrace
