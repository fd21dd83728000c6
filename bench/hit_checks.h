#pragma once

#include "core/camera.h"
#include "core/hit.h"
#include "core/triangle_mesh.h"

#include <cstdint>
#include <optional>
#include <span>

namespace tetrace {

/// What became of the rays, counted.
struct RayTotals {
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;
    std::uint64_t misses = 0;
    std::uint64_t lost = 0;
    std::uint64_t unwritten = 0; ///< hit records that still hold POISON
    std::uint64_t hit_steps = 0;
    std::uint64_t miss_steps = 0;
    std::uint64_t lost_steps = 0;

    [[nodiscard]] std::uint64_t steps() const { return hit_steps + miss_steps + lost_steps; }
    void add(const RayTotals& other);
};
[[nodiscard]] RayTotals count_rays(std::span<const Hit> hits);

/// Rays on which two backends disagree.
struct Differences {
    std::uint64_t count = 0;
    std::optional<std::size_t> first; ///< index of the ray
};

/// Compares a backend's hits with openmp's, exact mode: face, tet and steps in every bit; t, u and v within 3 units in
/// the last place. A division is off by 2.5 of them at most (Vulkan and OpenCL promise that) and openmp's by a half.
[[nodiscard]] Differences compare_hits(std::span<const Hit> hits, std::span<const Hit> reference);

/// Units in the last place between two floats; huge where a sign differs or one is not finite.
[[nodiscard]] std::uint64_t ulps_between(float a, float b);

/// Counts hits whose point on the ray (by t) and on the triangle (by u and v) are further apart than rounding explains.
/// With o the origin, d the direction, e1 and e2 the triangle's edges from v0, and m = |o - v0| + |e1| + |e2|, each of
/// t |d|, u |e1| and v |e2| is a quotient of products of at most three lengths over det(d, e1, e2). Evaluated in float,
/// each is off by some 12 roundings of m |d| |e1| |e2| / |det|; three of them, and sums of three components: 64 is the
/// bound taken. hits: width * height, row after row. Faces beyond the mesh are counted as misplaced.
[[nodiscard]] std::uint64_t count_misplaced(const TriangleMesh& mesh, const View& view, std::uint32_t width,
                                            std::span<const Hit> hits);

} // namespace tetrace
