#include "core/bvh/box_grid.h"

namespace tetrace {
namespace {

constexpr int last_line = 255;

// Rounding in the division and in line_at() must not move a line into the box.
int line_below(const BoxGrid& grid, int axis, float x)
{
    int line = static_cast<int>(std::floor((double{x} - grid.origin[axis]) / grid.width(axis)));
    line = std::clamp(line, 0, last_line);
    while (line > 0 && line_at(grid, axis, static_cast<std::uint8_t>(line)) > x)
        --line;
    return line;
}

/// last_line + 1 where the grid ends before x.
int line_above(const BoxGrid& grid, int axis, float x)
{
    const double line = std::ceil((double{x} - grid.origin[axis]) / grid.width(axis));
    if (line > last_line) return last_line + 1;
    int above = std::max(0, static_cast<int>(line));
    while (above <= last_line && line_at(grid, axis, static_cast<std::uint8_t>(above)) < x)
        ++above;
    return above;
}

} // namespace

double line_at(const BoxGrid& grid, int axis, std::uint8_t line)
{
    return double{grid.origin[axis]} + line * grid.width(axis);
}

BoxGrid make_box_grid(const Box& box)
{
    BoxGrid grid{box.low, {}};
    for (int axis = 0; axis < 3; ++axis) {
        auto& exponent = grid.exponent[static_cast<std::size_t>(axis)];
        const double width = (double{box.high[axis]} - box.low[axis]) / last_line;
        exponent = static_cast<std::uint8_t>(std::clamp(width > 0 ? std::ilogb(width) + 127 : 1, 1, 254));
        while (exponent < 254 && line_above(grid, axis, box.high[axis]) > last_line)
            ++exponent;
    }
    return grid;
}

GridBox to_grid(const BoxGrid& grid, const Box& box)
{
    GridBox lines;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        lines.low[i] = static_cast<std::uint8_t>(line_below(grid, axis, box.low[axis]));
        lines.high[i] = static_cast<std::uint8_t>(std::min(last_line, line_above(grid, axis, box.high[axis])));
    }
    return lines;
}

} // namespace tetrace
