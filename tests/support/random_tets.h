#pragma once

#include "core/base/exact.h"
#include "core/pack/packed_scene.h"
#include "tests/support/random.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tetrace::test {

/// A tet of the kernels' orientation: det(V1-V0, V2-V0, V3-V0) < 0.
struct RandomTet {
    Float3 corners[4];
};

/// Swaps two corners where needed; false for a flat tet.
inline bool orient(RandomTet& tet)
{
    const int sign = orientation(tet.corners[0], tet.corners[1], tet.corners[2], tet.corners[3]);
    if (sign > 0) std::swap(tet.corners[2], tet.corners[3]);
    return sign != 0;
}

inline RandomTet random_tet(Random& random)
{
    for (;;) {
        RandomTet tet{{random.point(-1, 1), random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)}};
        if (orient(tet)) return tet;
    }
}

/// The same chance for each corner.
inline Float3 inner_point(const RandomTet& tet, Random& random)
{
    const float weight[4] = {random.unit(), random.unit(), random.unit(), random.unit()};
    const float sum = weight[0] + weight[1] + weight[2] + weight[3];
    Float3 point;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 4; ++k)
            point[axis] += tet.corners[k][axis] * weight[k] / sum;
    return snap_to_grid(point);
}

/// As rays are: no component in (0, 2^-20).
inline Float3 direction_between(Float3 from, Float3 to)
{
    Float3 direction;
    for (int axis = 0; axis < 3; ++axis) {
        const float component = to[axis] - from[axis];
        direction[axis] = std::abs(component) < 0x1p-20f ? 0.0f : component;
    }
    return direction;
}

inline Float3 random_direction(Random& random)
{
    return direction_between({}, random.point(-1, 1));
}

/// Faces that the exact line crosses in their interior, in the order in which it does.
struct Crossed {
    int count = 0;
    std::uint32_t first = 4, last = 4;
};
inline Crossed crossed_faces(const RandomTet& tet, Float3 origin, Float3 direction)
{
    std::vector<std::pair<double, std::uint32_t>> crossings;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto c = cross_exactly(origin, direction, tet.corners[(face + 1) % 4], tet.corners[(face + 2) % 4],
                                     tet.corners[(face + 3) % 4]);
        if (c.met && std::abs(c.edge_side[0] + c.edge_side[1] + c.edge_side[2]) == 3) crossings.push_back({c.t, face});
    }
    if (crossings.empty()) return {};
    std::sort(crossings.begin(), crossings.end());
    return {static_cast<int>(crossings.size()), crossings.front().second, crossings.back().second};
}

/// Tets in layout tet96, without neighbours.
inline PackedScene packed_tets(const std::vector<RandomTet>& tets)
{
    PackedScene packed;
    packed.layout = Layout::tet96;
    packed.tet_count = static_cast<std::uint32_t>(tets.size());
    for (const RandomTet& tet : tets) {
        for (const Float3 v : tet.corners)
            packed.tets.push_back({std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y),
                                   std::bit_cast<std::uint32_t>(v.z), 0});
        packed.tets.insert(packed.tets.end(), 2, {NO_HALF_FACE, FREE_FACE, NO_HALF_FACE, FREE_FACE});
    }
    return packed;
}

} // namespace tetrace::test
