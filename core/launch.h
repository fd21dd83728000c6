#pragma once

#include "core/backend.h"

#include <cstdint>

namespace tetrace {

/// What a device gets with each launch: LaunchParams of kernels/launch.h, word for word.
struct LaunchParams {
    Float3 origin, corner, step_x, step_y;
    std::uint32_t width, height, start_tet, max_steps;
    std::uint32_t divisions, first_tile, tile_height, part_log2;
};
static_assert(sizeof(LaunchParams) == 80, "every backend reads LaunchParams; see kernels/launch.h");

/// The params of a job's first launch.
[[nodiscard]] LaunchParams launch_params(const TraceJob& job, std::uint32_t divisions, unsigned tile_height,
                                         unsigned part_log2);

/// Tiles of an image, row after row.
[[nodiscard]] std::uint32_t tile_count(const TraceJob& job, unsigned tile_height);

/// Words of an image's output, guards included.
[[nodiscard]] std::size_t output_words(const TraceJob& job);

/// The tile height that is used where none is asked for, chosen by measurement per type of device (results/tiles.md).
[[nodiscard]] unsigned default_tile_height(const Device& device);

/// How many tiles a launch may hold so that it ends long before any watchdog fires (2 s is the shortest known): few at
/// first, then as many as fit into a tenth of a second at the speed that the last launches had.
class LaunchSize {
public:
    explicit LaunchSize(unsigned tile_height);
    [[nodiscard]] std::uint32_t tiles() const { return tiles_; }
    /// Tells how long a launch of that many tiles took.
    void took(std::uint32_t tiles, double seconds);

private:
    std::uint32_t tiles_;
};

} // namespace tetrace
