#pragma once

#include "core/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// Slots of a node's children, one of 8 each. A ray visits the slots by ascending slot xor octant, and so meets near
/// children early for every octant of its direction. An octant has bit 2 where the direction's x is negative, bit 1 y,
/// bit 0 z. offsets: of the children's centres from the node's centre, at most 8. The assignment has the least sum of
/// distances along the octants' directions. Source: Ylitie, Karras, Laine 2017, section 3 (child node order).
[[nodiscard]] std::vector<std::uint8_t> octant_slots(std::span<const Double3> offsets);

/// For a child in that slot: its distance from the node's centre along the octant's direction.
[[nodiscard]] double slot_cost(Double3 offset, std::uint32_t slot);

} // namespace tetrace
