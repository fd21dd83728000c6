#pragma once

#include "core/mesh/box.h"

#include <array>
#include <bit>
#include <cstdint>

namespace tetrace {

/// A grid of 255 cells along each axis over a box; its cells are powers of two wide.
struct BoxGrid {
    Float3 origin;
    std::array<std::uint8_t, 3> exponent = {}; ///< the float with bits exponent << 23 is a cell's width

    [[nodiscard]] double width(int axis) const
    {
        return std::bit_cast<float>(std::uint32_t{exponent[static_cast<std::size_t>(axis)]} << 23);
    }
};

/// A box in lines of a grid.
struct GridBox {
    std::array<std::uint8_t, 3> low = {}, high = {};
};

/// The finest grid that starts at the box's low corner and covers the box. box: not empty, at most 2^100 in size.
[[nodiscard]] BoxGrid make_box_grid(const Box& box);

/// The smallest box of grid lines around this box. box: inside the grid.
[[nodiscard]] GridBox to_grid(const BoxGrid& grid, const Box& box);

/// The coordinate of a grid line.
[[nodiscard]] double line_at(const BoxGrid& grid, int axis, std::uint8_t line);

} // namespace tetrace
