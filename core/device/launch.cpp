#include "core/device/launch.h"

#include "core/base/error.h"
#include "core/pack/kernel_id.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <string>

namespace tetrace {

namespace {

constexpr std::uint32_t first_launch_rays = 16'384;
constexpr double launch_target_s = 0.1;
constexpr double max_growth = 4;
constexpr std::uint32_t max_targets = 10; // of all passes of a launch: a second, half of the shortest watchdog

} // namespace

LaunchParams launch_params(const TraceJob& job, const PackedDomain& domain, unsigned tile_height, unsigned part_log2)
{
    return {job.view.origin, job.view.corner, job.view.step_x, job.view.step_y, job.width,        job.height,
            job.start_tet,   job.max_steps,   job.any_hit,     job.start,       domain.divisions, 0,
            tile_height,     part_log2,       domain.low,      domain.high};
}

std::vector<LaunchParams> launch_params(std::span<const TraceJob> jobs, const PackedDomain& domain,
                                        unsigned tile_height, unsigned part_log2)
{
    std::vector<LaunchParams> images;
    for (const TraceJob& job : jobs)
        images.push_back(launch_params(job, domain, tile_height, part_log2));
    return images;
}

std::uint32_t tile_count(const LaunchParams& image)
{
    return ((image.width + TILE_WIDTH - 1) / TILE_WIDTH) * ((image.height + image.tile_height - 1) / image.tile_height);
}

std::uint32_t stack_bytes_of_item(Layout layout)
{
    const bool has_stack = structure_of(layout) == Structure::bvh;
    return has_stack ? STACK_TOP_OF_GPUS * STACK_ENTRY_WORDS * sizeof(std::uint32_t) : 0;
}

std::size_t words_per_ray(Task task)
{
    return traits_of(task).words;
}

void require_output_fits(std::size_t words, std::uint64_t max_buffer_bytes)
{
    const std::uint64_t bytes = words * sizeof(std::uint32_t);
    if (max_buffer_bytes == 0 || bytes <= max_buffer_bytes) return;
    throw Error(ErrorKind::unsupported, "the hits have " + std::to_string(bytes) +
                                            " bytes, the device's largest buffer " + std::to_string(max_buffer_bytes) +
                                            "; trace smaller images, or fewer at once");
}

void require_rays_fit(std::span<const Quad> quads, std::uint64_t max_buffer_bytes)
{
    if (max_buffer_bytes == 0 || quads.size_bytes() <= max_buffer_bytes) return;
    throw Error(ErrorKind::unsupported, "the rays have " + std::to_string(quads.size_bytes()) +
                                            " bytes, the device's largest buffer " + std::to_string(max_buffer_bytes) +
                                            "; give fewer at once");
}

void require_output_of_last_launch(std::size_t asked, std::size_t available)
{
    if (asked == available) return;
    throw Error(ErrorKind::internal, "reading back: " + std::to_string(asked) +
                                         " results are asked for, the last launch has " + std::to_string(available));
}

LaunchSize::LaunchSize(unsigned tile_height) : tiles_(first_launch_rays / (TILE_WIDTH * tile_height)) {}

void LaunchSize::took(std::uint32_t tiles, double seconds)
{
    if (tiles == 0) return;
    const double fitting = seconds > 0 ? tiles * launch_target_s / seconds : no_limit;
    // A launch shorter than the limit says little about longer ones, so the size grows in steps but shrinks at once.
    const double largest = std::min<double>(no_limit, std::max<double>(tiles_, tiles * max_growth));
    tiles_ = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, largest));
}

std::uint32_t tile_count(std::span<const LaunchPiece> pieces)
{
    std::uint32_t tiles = 0;
    for (const LaunchPiece& piece : pieces)
        tiles += piece.tiles;
    return tiles;
}

void Launches::start(std::span<const LaunchParams> images, std::uint32_t passes, const Enqueue& enqueue,
                     const std::function<void()>& take_times, std::uint32_t in_flight)
{
    seconds_ = 0;
    jobs_ = images.size();
    first_pass_ = 0; // a launch that failed has left its own
    in_flight_ = 1;
    std::uint64_t tiles = 0;
    for (const LaunchParams& image : images)
        tiles += tile_count(image);
    for (std::uint32_t pass = 0; pass < passes;) {
        const bool fits = !is_first_pass_ && tiles > 0 && tiles <= size_.tiles();
        if (fits) {
            first_pass_ = pass;
            in_flight_ = in_flight;
            const std::uint32_t room = max_targets * (size_.tiles() / static_cast<std::uint32_t>(tiles));
            const std::uint32_t together = std::min(passes - pass, room);
            start_passes(images, together, enqueue, take_times);
            pass += together;
        } else {
            const std::uint32_t together = std::min(passes - pass, in_flight);
            start_as_one(images, pass, together, in_flight, enqueue, take_times);
            pass += together;
        }
    }
    first_pass_ = 0;
    in_flight_ = 1;
}

/// The images of several passes, as if they were those of one, each with the output that it has.
void Launches::start_as_one(std::span<const LaunchParams> images, std::uint32_t first, std::uint32_t passes,
                            std::uint32_t in_flight, const Enqueue& enqueue, const std::function<void()>& take_times)
{
    std::vector<LaunchParams> all;
    for (std::uint32_t output = 0; output < in_flight; ++output) {
        const bool has_pass = (output + in_flight - first % in_flight) % in_flight < passes;
        for (LaunchParams image : images) {
            if (!has_pass) image.first_tile = tile_count(image); // nothing is left of it
            all.push_back(image);
        }
    }
    first_pass_ = 0;
    in_flight_ = 1;
    start_passes(all, 1, enqueue, take_times);
}

std::vector<LaunchPiece> Launches::of_pass(std::span<const LaunchPiece> pieces, std::uint32_t pass) const
{
    std::vector<LaunchPiece> own(pieces.begin(), pieces.end());
    for (LaunchPiece& piece : own)
        piece.job += output_of(pass) * jobs_;
    return own;
}

/// As few launches as their size allows: each but the last is full, and holds the end of one job and more of the next.
void Launches::start_passes(std::span<const LaunchParams> images, std::uint32_t passes, const Enqueue& enqueue,
                            const std::function<void()>& take_times)
{
    std::vector<LaunchPiece> pieces;
    const auto launch = [&] {
        if (pieces.empty()) return;
        enqueue(pieces, passes);
        if (is_first_pass_) take_times();
        pieces.clear();
    };
    for (std::size_t job = 0; job < images.size(); ++job) {
        LaunchParams params = images[job];
        const std::uint32_t end = tile_count(params);
        while (params.first_tile < end) {
            const std::uint32_t used = tile_count(pieces);
            const std::uint32_t room = size_.tiles() > used ? size_.tiles() - used : 0;
            const std::uint32_t tiles = std::min({room, max_piece_tiles_, end - params.first_tile});
            if (tiles > 0) pieces.push_back({job, params, tiles});
            params.first_tile += tiles;
            if (tiles == room) launch();
        }
    }
    launch();
    is_first_pass_ = false;
}

void Launches::took(std::uint32_t tiles, std::uint32_t passes, double seconds)
{
    const std::uint64_t all = std::uint64_t{tiles} * passes;
    size_.took(static_cast<std::uint32_t>(std::min<std::uint64_t>(all, LaunchSize::no_limit)), seconds);
    seconds_ += seconds;
}

} // namespace tetrace
