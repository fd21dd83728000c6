#include "core/pack/hilbert.h"

#include <algorithm>
#include <array>

namespace tetrace {
namespace {

constexpr int bits = 16;

std::uint32_t to_cell(double unit)
{
    return static_cast<std::uint32_t>(std::clamp(unit, 0.0, 1.0) * ((1 << bits) - 1));
}

} // namespace

std::uint64_t hilbert_index(Double3 unit_point)
{
    std::array<std::uint32_t, 3> x = {to_cell(unit_point.x), to_cell(unit_point.y), to_cell(unit_point.z)};

    // Undo the rotations and reflections of each level, from the coarsest.
    for (std::uint32_t level = 1u << (bits - 1); level > 1; level >>= 1) {
        const std::uint32_t below = level - 1;
        for (auto& axis : x) {
            if ((axis & level) != 0) {
                x[0] ^= below;
            } else {
                const std::uint32_t swapped = (x[0] ^ axis) & below;
                x[0] ^= swapped;
                axis ^= swapped;
            }
        }
    }
    // Gray code.
    x[1] ^= x[0];
    x[2] ^= x[1];
    std::uint32_t gray = 0;
    for (std::uint32_t level = 1u << (bits - 1); level > 1; level >>= 1)
        if ((x[2] & level) != 0) gray ^= level - 1;
    for (auto& axis : x)
        axis ^= gray;

    std::uint64_t index = 0;
    for (int bit = bits - 1; bit >= 0; --bit)
        for (const auto axis : x)
            index = index << 1 | (axis >> bit & 1u);
    return index;
}

} // namespace tetrace
