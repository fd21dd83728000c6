#include "core/launch.h"

#include <algorithm>

namespace tetrace {

namespace {

constexpr std::uint32_t first_launch_rays = 16'384;
constexpr double launch_target_s = 0.1;
constexpr double largest_growth = 4;
constexpr double most_tiles = 1u << 20; // 2^26 rays at most: far below every API's limit on groups

} // namespace

LaunchParams launch_params(const TraceJob& job, std::uint32_t divisions, unsigned tile_height, unsigned part_log2)
{
    return {job.view.origin, job.view.corner, job.view.step_x, job.view.step_y, job.width,
            job.height,      job.start_tet,   job.max_steps,   divisions,       0,
            tile_height,     part_log2};
}

std::uint32_t tile_count(const TraceJob& job, unsigned tile_height)
{
    return ((job.width + TILE_WIDTH - 1) / TILE_WIDTH) * ((job.height + tile_height - 1) / tile_height);
}

std::size_t output_words(const TraceJob& job)
{
    return 2 * std::size_t{GUARD_WORDS} + std::size_t{HIT_WORDS} * job.width * job.height;
}

unsigned default_tile_height(const Device&)
{
    return 8;
}

LaunchSize::LaunchSize(unsigned tile_height) : tiles_(first_launch_rays / (TILE_WIDTH * tile_height)) {}

void LaunchSize::took(std::uint32_t tiles, double seconds)
{
    if (tiles == 0) return;
    const double fitting = seconds > 0 ? tiles * launch_target_s / seconds : most_tiles;
    // A launch shorter than the limit says little about longer ones: growth is by steps, shrinking at once.
    const double largest = std::min(most_tiles, std::max<double>(tiles_, tiles * largest_growth));
    tiles_ = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, largest));
}

} // namespace tetrace
