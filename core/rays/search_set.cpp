#include "core/rays/search_set.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/base/random_words.h"
#include "core/mesh/tet_mesh.h"
#include "core/pack/kernel_id.h"

#include <array>
#include <bit>
#include <cstdlib>
#include <string>
#include <utility>

namespace tetrace {
namespace {

constexpr int unit_log2 = 16;
constexpr std::int64_t one = std::int64_t{1} << unit_log2;
constexpr std::int64_t min_determinant = std::int64_t{1} << (3 * unit_log2 - 20);

/// In units of 2^-16. Corners are below 2^17 in magnitude, directions below 2^18, origins below 2^20, so that a side
/// product is below 2^62.
struct Int3 {
    std::int64_t x = 0, y = 0, z = 0;

    friend bool operator==(const Int3&, const Int3&) = default;
    friend Int3 operator+(Int3 a, Int3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Int3 operator-(Int3 a, Int3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Int3 operator*(Int3 a, std::int64_t s) { return {a.x * s, a.y * s, a.z * s}; }
    friend Int3 operator>>(Int3 a, int bits) { return {a.x >> bits, a.y >> bits, a.z >> bits}; }
};

Int3 cross(Int3 a, Int3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::int64_t dot(Int3 a, Int3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Float3 to_float(Int3 a)
{
    const auto scaled = [](std::int64_t value) { return static_cast<float>(value) * (1.0F / one); };
    return {scaled(a.x), scaled(a.y), scaled(a.z)};
}

Float3 cross(Float3 a, Float3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr std::uint32_t search_stream = 0;

RandomWords random_words(std::uint32_t tet, std::uint32_t ray, std::uint32_t attempt, std::uint32_t dimension)
{
    return tetrace::random_words({tet, ray, attempt, dimension}, search_stream);
}

using Corners = std::array<Int3, 4>;
constexpr std::uint32_t no_ray = 0xFFFFFFFF; // the words of the tet itself

std::int64_t random_coordinate(std::uint32_t word)
{
    return static_cast<std::int64_t>(word >> (31 - unit_log2)) - one;
}

Corners tet_of(std::uint32_t number)
{
    for (std::uint32_t attempt = 0;; ++attempt) {
        Corners corners;
        for (std::uint32_t i = 0; i < 4; ++i) {
            const RandomWords words = random_words(number, no_ray, attempt, i);
            corners[i] = {random_coordinate(words[0]), random_coordinate(words[1]), random_coordinate(words[2])};
        }
        const std::int64_t determinant =
            dot(cross(corners[1] - corners[0], corners[2] - corners[0]), corners[3] - corners[0]);
        if (determinant > 0) std::swap(corners[2], corners[3]); // negative, as for packed tets
        if (std::abs(determinant) >= min_determinant) return corners;
    }
}

/// A point of a face by 16-bit coordinates along two of its edges, rounded to a unit.
Int3 point_of(const Corners& corners, std::uint32_t face, std::uint32_t word)
{
    constexpr std::uint32_t all = 0xFFFF;
    std::uint32_t a = word & all, b = word >> 16;
    if (a + b > all) { // the other half of the parallelogram
        a = all - a;
        b = all - b;
    }
    const auto& [c0, c1, c2] = face_corners[face];
    return corners[c0] + (((corners[c1] - corners[c0]) * a + (corners[c2] - corners[c0]) * b) >> 16);
}

struct IntRay {
    Int3 origin, direction;
};

/// Side of the ray with respect to the directed edge, as side_of_edge() of kernels/layouts/faces.h, exact.
std::int64_t side(const IntRay& ray, Int3 from, Int3 to)
{
    return dot(cross(ray.origin - from, ray.direction), to - from);
}

/// The faces by which the ray leaves, a bit each; none if it does not enter through the inside of the entry face.
/// The table of docs/spec/methods.md, M1.
std::uint8_t exits_of(const Corners& corners, std::uint32_t entry, const IntRay& ray)
{
    const auto& face = face_corners[entry];
    const Int3 apex = corners[entry];
    std::array<std::int64_t, 3> at_apex;
    for (std::size_t i = 0; i < 3; ++i) {
        if (side(ray, corners[face[i]], corners[face[(i + 1) % 3]]) <= 0) return 0;
        at_apex[i] = side(ray, corners[face[i]], apex);
    }
    unsigned exits = 0;
    for (std::size_t i = 0; i < 3; ++i)
        if (at_apex[i] <= 0 && at_apex[(i + 1) % 3] >= 0) exits |= 1u << face[(i + 2) % 3];
    return static_cast<std::uint8_t>(exits);
}

struct StabbingRay {
    IntRay ray;
    std::uint32_t entry;
    std::uint8_t exits;
};

StabbingRay ray_of(const Corners& corners, std::uint32_t tet, std::uint32_t number)
{
    for (std::uint32_t attempt = 0;; ++attempt) {
        const RandomWords words = random_words(tet, number, attempt, 0);
        const std::uint32_t entry = words[2] & 3u;
        const std::uint32_t other = (entry + 1 + (words[2] >> 2 & 0xFFFF) % 3) & 3u;
        const std::int64_t sixteenths = 4 + (words[3] >> 16) % 61; // 1/4 to 4
        const Int3 from = point_of(corners, entry, words[0]);
        const Int3 direction = point_of(corners, other, words[1]) - from;
        const IntRay ray = {from - (direction * sixteenths >> 4), direction};
        if (direction == Int3{}) continue;
        if (const std::uint8_t exits = exits_of(corners, entry, ray); exits != 0) return {ray, entry, exits};
    }
}

Quad quad_of(Float3 a, std::uint32_t last)
{
    return {std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y), std::bit_cast<std::uint32_t>(a.z),
            last};
}

/// The inverse of quad_of().
Int3 to_int(const Quad& quad)
{
    const auto scaled = [](std::uint32_t bits) {
        return static_cast<std::int64_t>(static_cast<double>(std::bit_cast<float>(bits)) * one);
    };
    return {scaled(quad.x), scaled(quad.y), scaled(quad.z)};
}

Double3 to_double(Int3 a)
{
    return tetrace::to_double(to_float(a));
}

/// The distance between the ray's line and the edge's. They do not meet: their side product is not 0.
double distance_of_lines(const IntRay& ray, Int3 from, Int3 to)
{
    const Double3 across = tetrace::cross(to_double(ray.direction), to_double(to - from));
    return std::abs(tetrace::dot(to_double(from - ray.origin), across)) / length(across);
}

} // namespace

PackedScene search_tets(std::uint32_t count, Layout layout)
{
    TetMesh mesh;
    mesh.vertices.reserve(4 * std::size_t{count});
    mesh.tets.reserve(count);
    for (std::uint32_t tet = 0; tet < count; ++tet) {
        for (const Int3& corner : tet_of(tet))
            mesh.vertices.push_back(to_float(corner));
        const std::uint32_t first = 4 * tet;
        mesh.tets.push_back({{first, first + 1, first + 2, first + 3},
                             {NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE},
                             {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    }
    PackedScene packed;
    packed.layout = layout;
    packed.tet_count = count;
    std::get<PackTets*>(traits_of(layout).pack)(packed, mesh);
    return packed;
}

SearchRays search_rays(std::uint32_t first_tet, std::uint32_t tets, std::uint32_t rays_per_tet)
{
    if (rays_per_tet % TILE_WIDTH != 0)
        throw Error(ErrorKind::internal, "rays of a tet come in multiples of " + std::to_string(TILE_WIDTH) + ", not " +
                                             std::to_string(rays_per_tet));
    const std::size_t count = std::size_t{tets} * rays_per_tet;
    SearchRays rays;
    rays.quads.resize(RAY_QUADS * count);
    rays.exits.resize(count);
    std::size_t i = 0;
    for (std::uint32_t tet = first_tet; tet < first_tet + tets; ++tet) {
        const Corners corners = tet_of(tet);
        for (std::uint32_t number = 0; number < rays_per_tet; ++number, ++i) {
            const StabbingRay stab = ray_of(corners, tet, number);
            const Float3 origin = to_float(stab.ray.origin), direction = to_float(stab.ray.direction);
            rays.quads[i] = quad_of(direction, make_half_face(tet, stab.entry));
            rays.quads[count + i] = quad_of(origin, 0);
            rays.quads[2 * count + i] = quad_of(cross(origin, direction), 0);
            rays.exits[i] = stab.exits;
        }
    }
    return rays;
}

SearchVerdict judge(const SearchRays& rays, std::size_t number, std::uint32_t face)
{
    if (face == NO_EXIT) return SearchVerdict::lost;
    if ((rays.exits[number] >> face & 1u) != 0) return SearchVerdict::right;
    const std::uint32_t half_face = rays.half_face(number);
    if (face == half_face_index(half_face)) return SearchVerdict::wrong;
    const IntRay ray = {to_int(rays.quads[rays.count() + number]), to_int(rays.quads[number])};
    const double bound = tie_bound(to_float(ray.origin));
    const Corners corners = tet_of(half_face_tet(half_face));
    for (std::size_t i = 0; i < 3; ++i) {
        const Int3 from = corners[face_corners[face][i]], to = corners[face_corners[face][(i + 1) % 3]];
        if (side(ray, from, to) > 0 && distance_of_lines(ray, from, to) > bound) return SearchVerdict::wrong;
    }
    return SearchVerdict::tie;
}

} // namespace tetrace
