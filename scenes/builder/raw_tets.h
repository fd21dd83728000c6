#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace {

/// Tets as a library made them, in double coordinates: corner i and neighbour i of a tet are opposite each other.
struct RawTets {
    /// A face that the library was to keep: an input triangle's, by its index, or the domain's (-1).
    struct SurfaceFace {
        std::array<std::int32_t, 3> corners;
        std::int32_t triangle;
    };

    std::vector<Double3>
        points; ///< the input's first (mesh, surface), in its order; then more vertices, Steiner points
    std::size_t input_points = 0;
    std::vector<std::array<std::int32_t, 4>> tets;       ///< positive: (c1 - c0) x (c2 - c0) . (c3 - c0) > 0
    std::vector<std::array<std::int32_t, 4>> neighbours; ///< -1 outside the domain
    std::vector<SurfaceFace> surface_faces;
    std::uint64_t flat_tets = 0; ///< no volume, or a negative one, already in these coordinates
    std::string_view maker = "TetGen";
};

} // namespace tetrace
