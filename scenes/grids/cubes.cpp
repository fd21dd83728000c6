// A blocky ball in a grid of cubes.
#include "core/base/error.h"
#include "scenes/grids/cube_grid.h"
#include "scenes/procedural.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// Centres within 0.6 of the box's half-size, in integers. Two cubes along an axis have none that near: there one cube
/// represents the ball, and its surface is open towards the domain's boundary.
bool in_ball(const CubeGrid::Cell& cube, std::int32_t n)
{
    if (n == 2) return cube == CubeGrid::Cell{0, 0, 0};
    std::int32_t distance = 0;
    for (const std::int32_t i : cube)
        distance += (2 * i + 1 - n) * (2 * i + 1 - n);
    return 25 * distance <= 9 * n * n;
}

} // namespace

Scene make_cubes(std::uint32_t resolution)
{
    if (resolution < 2 || resolution > 128)
        throw Error(ErrorKind::usage,
                    fmt::format("making scene cubes: {} cubes along an axis; 2 to 128 are accepted", resolution));
    return CubeGrid(resolution).make("cubes", [n = static_cast<std::int32_t>(resolution)](const CubeGrid::Cell& cube) {
        return in_ball(cube, n);
    });
}

} // namespace tetrace
