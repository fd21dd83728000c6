// Solid cubes scattered through a grid of cubes.
#include "core/base/error.h"
#include "core/base/file_bytes.h"
#include "scenes/catalogue.h"
#include "scenes/grids/cube_grid.h"
#include "scenes/procedural.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <unistd.h>

namespace tetrace {

namespace {

/// Whether the cube is solid: 4 of 3 n are. A cube shows 1.5 times the area of its side to a line, on average over all
/// directions, so a line goes through n / 2 cubes before it meets a solid one. None is solid at the domain's sides.
bool is_solid(const CubeGrid::Cell& cube, std::int32_t n)
{
    for (const std::int32_t i : cube)
        if (i == 0 || i == n - 1) return false;
    if (cube == CubeGrid::Cell{n / 2, n / 2, n / 2}) return true; // so that no lattice is empty
    const auto number = static_cast<std::uint32_t>((cube[2] * n + cube[1]) * n + cube[0]);
    return scramble(~number) % static_cast<std::uint32_t>(3 * n) < 4;
}

/// What the system can still hand out without swapping, in bytes; all of its memory where it does not say.
std::uint64_t available_memory()
{
    const std::string text = file_bytes("/proc/meminfo").value_or("");
    constexpr std::string_view key = "MemAvailable:";
    if (const std::size_t place = text.find(key); place != std::string::npos)
        return 1024 * std::strtoull(text.c_str() + place + key.size(), nullptr, 10);
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
}

/// Memory that the system hands out is not always there; a process that uses more is killed. Packing has all tets once
/// more, in its order.
void require_memory(std::uint64_t n)
{
    const std::uint64_t needed = 2 * lattice_tets(n) * sizeof(Tet) + (n + 1) * (n + 1) * (n + 1) * sizeof(Float3);
    if (const std::uint64_t there = available_memory(); needed > there)
        throw Error(ErrorKind::unsupported,
                    fmt::format("making scene lattice:{}: its {} tets take {} bytes until they are packed, and this "
                                "machine has {} left; use a smaller one",
                                n, lattice_tets(n), needed, there));
}

} // namespace

Scene make_lattice(std::uint32_t resolution)
{
    if (resolution < min_lattice || resolution > max_lattice)
        throw Error(ErrorKind::usage, fmt::format("making scene lattice: {} cubes along an axis; {} to {} are accepted",
                                                  resolution, min_lattice, max_lattice));
    require_memory(resolution);
    return CubeGrid(resolution)
        .make("lattice",
              [n = static_cast<std::int32_t>(resolution)](const CubeGrid::Cell& cube) { return is_solid(cube, n); });
}

} // namespace tetrace
