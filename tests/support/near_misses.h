#pragma once

#include "bench/truth/exact_ray.h"
#include "core/base/exact.h"
#include "core/base/random_words.h"
#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tetrace::test {

/// Rays from outside a mesh that pass an edge of it, or a corner, within a few bounds: where answers are hardest to
/// judge. A function of only their number.
class NearMisses {
public:
    /// mesh: kept by reference; it is in [-1, 1]^3.
    explicit NearMisses(const TriangleMesh& mesh) : mesh_(mesh) {}

    [[nodiscard]] ExactRay ray(std::uint32_t number) const
    {
        const auto& triangle = mesh_.triangles[below(number, 0, static_cast<std::uint32_t>(mesh_.triangles.size()))];
        const std::uint32_t corner = below(number, 1, 3);
        const Double3 a = to_double(mesh_.vertices[triangle[corner]]);
        const Double3 b = to_double(mesh_.vertices[triangle[(corner + 1) % 3]]);
        const double along = below(number, 2, 4) == 0 ? 0 : unit(number, 3); // a corner: every fourth
        const Double3 way = random_direction({stream, number, 0, 0});
        const Float3 origin = snap_to_grid(to_float(way * (2 + 2 * unit(number, 4))));
        const double bounds = below(number, 5, 2) == 0 ? 1 : 4;
        const Double3 off = random_direction({stream, number, 1, 0}) * (tie_bound(origin) * bounds * unit(number, 6));
        return {origin, clean(a + (b - a) * along + off - to_double(origin))};
    }

private:
    static constexpr std::uint32_t stream = 102;

    static std::uint32_t word(std::uint32_t number, std::uint32_t what)
    {
        return random_words({number, what, 0, 0}, stream)[0];
    }
    static std::uint32_t below(std::uint32_t number, std::uint32_t what, std::uint32_t limit)
    {
        return static_cast<std::uint32_t>(std::uint64_t{word(number, what)} * limit >> 32);
    }
    static double unit(std::uint32_t number, std::uint32_t what) { return (word(number, what) + 0.5) * 0x1p-32; }

    static Float3 clean(Double3 direction)
    {
        Float3 cleaned = to_float(direction * (1 / length(direction)));
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(cleaned[axis]) < 0x1p-20f) cleaned[axis] = 0;
        return cleaned;
    }

    const TriangleMesh& mesh_;
};

} // namespace tetrace::test
