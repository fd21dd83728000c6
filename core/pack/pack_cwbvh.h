#pragma once

#include "core/base/vec.h"
#include "core/mesh/box.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

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

/// Slots of a node's children, one of 8 each. A ray visits the slots by ascending slot xor octant, and so meets near
/// children early for every octant of its direction. An octant has bit 2 where the direction's x is negative, bit 1 y,
/// bit 0 z. offsets: of the children's centres from the node's centre, at most 8. The assignment has the least sum of
/// distances along the octants' directions. Source: Ylitie, Karras, Laine 2017, section 3 (child node order).
[[nodiscard]] std::vector<std::uint8_t> octant_slots(std::span<const Double3> offsets);

/// For a child in that slot: its distance from the node's centre along the octant's direction.
[[nodiscard]] double slot_cost(Double3 offset, std::uint32_t slot);

} // namespace tetrace
