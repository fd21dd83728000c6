#pragma once

#include "core/base/exact.h"
#include "core/base/random_words.h"
#include "core/rays/ray_set.h"
#include "core/rays/ray_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tetrace::test {

/// What rays are built like, to break a walk: whole lines from outside the domain, then those that start inside.
enum class HardKind {
    chord,       ///< uniform through the domain
    at_vertex,   ///< at a vertex of the tets
    at_edge,     ///< at a point of an edge
    along_edge,  ///< through both ends of an edge
    in_face,     ///< through two points of a face's outline
    from_vertex, ///< the rest start at such a place or in a tet, mostly towards another one of any tet
    from_edge,
    from_face,
    from_inside,
};
inline constexpr std::uint64_t hard_kinds = 9;

/// Rays through one scene, a function of only their number, the same on every machine: kind number % hard_kinds.
/// Those that start inside name a face of a tet that has the place, by which their line enters it; of from_inside the
/// one opposite to the direction.
class HardRays {
public:
    /// scene: kept by reference.
    explicit HardRays(const Scene& scene)
        : scene_(scene), centre_((low() + high()) * 0.5), reach_(length(high() - low()))
    {
    }

    [[nodiscard]] static HardKind kind_of(std::uint64_t number) { return HardKind(number % hard_kinds); }

    [[nodiscard]] GivenRay ray(std::uint64_t number) const
    {
        Draws draws(number);
        const HardKind kind = kind_of(number);
        const Place place = place_of(draws);
        GivenRay ray{{}, {}, NO_END, NO_HALF_FACE, FREE_FACE, 0};
        switch (kind) {
        case HardKind::chord: return from_sphere(ray, draws, on_sphere(draws));
        case HardKind::at_vertex: return from_sphere(ray, draws, place.at({1, 0, 0}));
        case HardKind::at_edge: return from_sphere(ray, draws, place.at(on_edge(draws)));
        case HardKind::along_edge: return through(ray, draws, place.at({1, 0, 0}), place.at({0, 1, 0}));
        case HardKind::in_face: return through(ray, draws, place.at(on_edge(draws)), place.at({0, 0, 1}));
        case HardKind::from_vertex: return from(ray, draws, place, place.at({1, 0, 0}));
        case HardKind::from_edge: return from(ray, draws, place, place.at(on_edge(draws)));
        case HardKind::from_face: return from(ray, draws, place, place.at(in_face(draws)));
        case HardKind::from_inside: return from_inside(ray, draws, place);
        }
        return ray;
    }

private:
    /// Four random words after the other.
    class Draws {
    public:
        explicit Draws(std::uint64_t number)
            : place_{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 0, 0}
        {
        }
        std::uint32_t word()
        {
            if (next_ == 4) {
                words_ = random_words(place_, stream);
                ++place_[2];
                next_ = 0;
            }
            return words_[next_++];
        }
        std::uint32_t below(std::uint32_t limit)
        {
            return static_cast<std::uint32_t>(std::uint64_t{word()} * limit >> 32);
        }
        double unit() { return (word() + 0.5) * 0x1p-32; }
        Double3 direction() { return random_direction({stream, place_[0], place_[1], 0x80000000u + place_[2]++}); }

    private:
        static constexpr std::uint32_t stream = 100;
        RandomWords place_, words_{};
        std::size_t next_ = 4;
    };

    /// A face of a tet, its corners in a random order, and the corner opposite.
    struct Place {
        std::uint32_t tet, face;
        std::array<Float3, 3> corners;
        Float3 apex;

        [[nodiscard]] Double3 at(Double3 weights) const
        {
            return to_double(corners[0]) * weights.x + to_double(corners[1]) * weights.y +
                   to_double(corners[2]) * weights.z;
        }
    };

    /// No triangle, but a place that may lie on some: the oracle takes one within the bound of a start for a tie.
    [[nodiscard]] std::uint32_t a_place() const { return static_cast<std::uint32_t>(scene_.mesh.triangles.size()); }
    [[nodiscard]] Double3 low() const { return to_double(scene_.domain.low()); }
    [[nodiscard]] Double3 high() const { return to_double(scene_.domain.high()); }

    [[nodiscard]] Place place_of(Draws& draws) const
    {
        const auto& mesh = scene_.tets;
        Place place{draws.below(static_cast<std::uint32_t>(mesh.tets.size())), draws.below(4), {}, {}};
        const auto& vertices = mesh.tets[place.tet].vertices;
        std::array<std::uint32_t, 3> at{};
        for (std::uint32_t i = 0, n = 0; i < 4; ++i)
            if (i != place.face) at[n++] = vertices[i];
        std::swap(at[0], at[draws.below(3)]);
        std::swap(at[1], at[1 + draws.below(2)]);
        for (std::size_t i = 0; i < 3; ++i)
            place.corners[i] = mesh.vertices[at[i]];
        place.apex = mesh.vertices[vertices[place.face]];
        return place;
    }

    static Double3 on_edge(Draws& draws)
    {
        const double t = draws.below(2) == 0 ? 0.5 : draws.unit(); // the middle is exact in many grids
        return {t, 1 - t, 0};
    }
    static Double3 in_face(Draws& draws)
    {
        if (draws.below(2) == 0) return {0.25, 0.25, 0.5};
        const double a = draws.unit(), b = draws.unit() * (1 - a);
        return {a, b, 1 - a - b};
    }

    [[nodiscard]] Double3 on_sphere(Draws& draws) const { return centre_ + draws.direction() * (0.53125 * reach_); }

    static Float3 snapped(Double3 point) { return snap_to_grid(to_float(point)); }

    /// As the kernels want it: its largest component between 1/2 and 1, those below 2^-20 zero; the x axis for the zero
    /// vector.
    static Float3 clean(Double3 direction)
    {
        const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
        if (largest == 0) return {1, 0, 0};
        int exponent = 0;
        (void)std::frexp(largest, &exponent);
        Float3 cleaned = to_float(direction * std::ldexp(1.0, -exponent)); // exact scaling: the same line
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(cleaned[axis]) < 0x1p-20f) cleaned[axis] = 0;
        return cleaned;
    }

    /// From a point of a sphere around the domain.
    GivenRay from_sphere(GivenRay ray, Draws& draws, Double3 target) const
    {
        ray.origin = snapped(on_sphere(draws));
        ray.direction = clean(target - to_double(ray.origin));
        return ray;
    }

    /// Along the line through two points, from outside: moved back by a power of two, which mostly keeps it exact.
    GivenRay through(GivenRay ray, Draws& draws, Double3 a, Double3 b) const
    {
        ray.direction = clean(draws.below(2) == 0 ? b - a : a - b);
        for (double back = 0.25; back <= 8; back *= 2) {
            ray.origin = snapped(a - to_double(ray.direction) * back);
            if (!scene_.domain.contains(ray.origin)) break;
        }
        return ray;
    }

    /// Towards a place of any tet, along an axis or a diagonal, or anywhere.
    [[nodiscard]] Float3 way_from(Draws& draws, Double3 origin) const
    {
        const std::uint32_t choice = draws.below(4);
        if (choice == 0) return clean(draws.direction());
        if (choice == 1) return clean({draws.below(3) - 1.0, draws.below(3) - 1.0, draws.below(3) - 1.0});
        const Place other = place_of(draws);
        return clean(other.at(choice == 2 ? Double3{1, 0, 0} : on_edge(draws)) - origin);
    }

    /// The face is entered: the ray goes to the apex's side of its plane, or runs in the plane.
    GivenRay from(GivenRay ray, Draws& draws, const Place& place, Double3 origin) const
    {
        ray.origin = snapped(origin);
        const Double3 way = draws.below(4) == 0 ? place.at({0, 0, 1}) - to_double(ray.origin) : Double3{};
        ray.direction = length(way) > 0 ? clean(way) : way_from(draws, to_double(ray.origin));
        const Double3 a = to_double(place.corners[0]);
        const Double3 normal = cross(to_double(place.corners[1]) - a, to_double(place.corners[2]) - a);
        if (dot(normal, to_double(place.apex) - a) * dot(normal, to_double(ray.direction)) < 0)
            for (int axis = 0; axis < 3; ++axis)
                ray.direction[axis] = -ray.direction[axis];
        ray.half_face = make_half_face(place.tet, place.face);
        ray.triangle = scene_.tets.tets[place.tet].faces[place.face];
        if (ray.triangle == FREE_FACE) ray.triangle = a_place();
        return ray;
    }

    GivenRay from_inside(GivenRay ray, Draws& draws, const Place& place) const
    {
        const double t = draws.below(2) == 0 ? 0.25 : draws.unit();
        ray.origin = snapped(place.at(in_face(draws)) * (1 - t) + to_double(place.apex) * t);
        ray.direction = way_from(draws, to_double(ray.origin));
        ray.half_face = make_half_face(place.tet, face_behind(scene_.tets, place.tet, ray.origin, ray.direction));
        ray.triangle = a_place();
        return ray;
    }

    const Scene& scene_;
    Double3 centre_;
    double reach_;
};

/// So many rays from number `first` on, a multiple of TILE_WIDTH, as a set that any session takes.
[[nodiscard]] inline RaySet hard_ray_set(const Scene& scene, std::uint64_t first, std::size_t count)
{
    const HardRays rays(scene);
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    for (std::size_t i = 0; i < count; ++i) {
        set.rays.push_back(rays.ray(first + i));
        set.rays.back().pixel = static_cast<std::uint32_t>(i);
    }
    return set;
}

} // namespace tetrace::test
