#include "core/pack/octant_slots.h"

#include <array>
#include <bit>
#include <limits>

namespace tetrace {

double slot_cost(Double3 offset, std::uint32_t slot)
{
    return ((slot & 4) != 0 ? -offset.x : offset.x) + ((slot & 2) != 0 ? -offset.y : offset.y) +
           ((slot & 1) != 0 ? -offset.z : offset.z);
}

// The first n children occupy a set of n slots. The best assignment to that set extends the best assignment to a subset
// of n - 1 slots.
std::vector<std::uint8_t> octant_slots(std::span<const Double3> offsets)
{
    constexpr std::uint32_t sets = 256;
    std::array<double, sets> least = {};
    std::array<std::uint8_t, sets> last_slot = {};
    for (std::uint32_t taken = 1; taken < sets; ++taken) {
        const auto child = static_cast<std::size_t>(std::popcount(taken)) - 1;
        if (child >= offsets.size()) continue;
        least[taken] = std::numeric_limits<double>::infinity();
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            if ((taken >> slot & 1) == 0) continue;
            const double cost = least[taken & ~(1u << slot)] + slot_cost(offsets[child], slot);
            if (cost < least[taken]) {
                least[taken] = cost;
                last_slot[taken] = static_cast<std::uint8_t>(slot);
            }
        }
    }

    std::uint32_t best = sets;
    for (std::uint32_t taken = 0; taken < sets; ++taken)
        if (static_cast<std::size_t>(std::popcount(taken)) == offsets.size() &&
            (best == sets || least[taken] < least[best]))
            best = taken;
    std::vector<std::uint8_t> slots(offsets.size());
    for (std::size_t child = offsets.size(); child-- > 0;) {
        slots[child] = last_slot[best];
        best &= ~(1u << slots[child]);
    }
    return slots;
}

} // namespace tetrace
