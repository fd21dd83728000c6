#pragma once

#include "core/device/backend.h"
#include "kernels/layouts/layout.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tetrace {

/// The parameters of a launch: LaunchParams of kernels/launch.h, word for word.
struct LaunchParams {
    Float3 origin, corner, step_x, step_y;
    std::uint32_t width, height, start_tet, max_steps, any_hit;
    StartTet start;
    std::uint32_t divisions, first_tile, tile_height, part_log2;
    Float3 domain_low, domain_high;
};
static_assert(sizeof(LaunchParams) == 128, "every backend reads LaunchParams, see kernels/launch.h; Vulkan promises "
                                           "push constants of no more");

/// The params of a job's first launch.
[[nodiscard]] LaunchParams launch_params(const TraceJob& job, const PackedDomain& domain, unsigned tile_height,
                                         unsigned part_log2);

/// The same for each of some jobs.
[[nodiscard]] std::vector<LaunchParams> launch_params(std::span<const TraceJob> jobs, const PackedDomain& domain,
                                                      unsigned tile_height, unsigned part_log2);

/// Tiles of an image, row after row.
[[nodiscard]] std::uint32_t tile_count(const LaunchParams& image);

/// Bytes of a work group's memory that a kernel needs on a GPU for each item: the top of its ray's stack
/// (kernels/stack.h).
[[nodiscard]] std::uint32_t stack_bytes_of_item(Layout layout);

/// Words that a kernel writes per ray: its answer.
[[nodiscard]] std::size_t words_per_ray(Task task);

/// Throws Error{unsupported} with both numbers if a launch's output exceeds the largest buffer; 0 is not a limit.
void require_output_fits(std::size_t words, std::uint64_t max_buffer_bytes);
/// The same for a session's rays.
void require_rays_fit(std::span<const Quad> quads, std::uint64_t max_buffer_bytes);

/// Throws Error{internal} if the results to read back are not those of the last launch.
void require_output_of_last_launch(std::size_t asked, std::size_t available);

/// How many tiles a launch may have so that it ends long before any watchdog fires (2 s is the shortest known): few at
/// first, then as many as fit into a tenth of a second at the speed of the last launches.
class LaunchSize {
public:
    static constexpr std::uint32_t no_limit = 1u << 20; ///< 2^26 rays at most: far below most APIs' limit on groups

    explicit LaunchSize(unsigned tile_height);
    [[nodiscard]] std::uint32_t tiles() const { return tiles_; }
    /// Reports how long a launch of that many tiles took.
    void took(std::uint32_t tiles, double seconds);

private:
    std::uint32_t tiles_;
};

/// Successive tiles of one of the jobs of a launch.
struct LaunchPiece {
    std::size_t job;
    LaunchParams params;
    std::uint32_t tiles; ///< from params.first_tile on
};

/// Tiles of all pieces.
[[nodiscard]] std::uint32_t tile_count(std::span<const LaunchPiece> pieces);

/// Cuts a session's jobs into launches, and adds up the seconds of the launches of one start().
class Launches {
public:
    /// max_piece_tiles: of a piece, if the API has a limit.
    explicit Launches(unsigned tile_height, std::uint32_t max_piece_tiles = LaunchSize::no_limit)
        : size_(tile_height), max_piece_tiles_(max_piece_tiles)
    {
    }
    /// Starts a launch of pieces, which are in flight together, this many times.
    using Enqueue = std::function<void(std::span<const LaunchPiece> pieces, std::uint32_t passes)>;
    /// Calls enqueue for each launch. images: the params of each job, from its first tile on. passes: of all jobs; if a
    /// launch may have all their tiles, as many passes as fit into a second are one call. take_times must call took().
    /// During the session's first pass it is called after each launch, because nothing is known yet about how long a
    /// launch takes. in_flight: passes that may be on the device together (TraceJob::in_flight); enqueue lets each pass
    /// wait for the one that is in_flight before it. If a launch has room for a part of a pass only, the launches cut
    /// in_flight passes as one: each holds the end of a pass and more of the next.
    void start(std::span<const LaunchParams> images, std::uint32_t passes, const Enqueue& enqueue,
               const std::function<void()>& take_times, std::uint32_t in_flight = 1);
    /// For enqueue: which of the outputs of passes in flight together a pass of the launch has.
    [[nodiscard]] std::uint32_t output_of(std::uint32_t pass) const { return (first_pass_ + pass) % in_flight_; }
    /// For enqueue: the pieces of a pass; `job` is the part of the output that it writes.
    [[nodiscard]] std::vector<LaunchPiece> of_pass(std::span<const LaunchPiece> pieces, std::uint32_t pass) const;
    /// For enqueue: outputs that passes of the launch write in turn.
    [[nodiscard]] std::uint32_t in_flight() const { return in_flight_; }
    /// Reports how long a launch of that many tiles took on the device, all its passes together.
    void took(std::uint32_t tiles, std::uint32_t passes, double seconds);
    /// Of the launches that were reported to took() since start() was called.
    [[nodiscard]] double seconds() const { return seconds_; }

private:
    void start_as_one(std::span<const LaunchParams> images, std::uint32_t first, std::uint32_t passes,
                      std::uint32_t in_flight, const Enqueue& enqueue, const std::function<void()>& take_times);
    void start_passes(std::span<const LaunchParams> images, std::uint32_t passes, const Enqueue& enqueue,
                      const std::function<void()>& take_times);

    LaunchSize size_;
    std::uint32_t max_piece_tiles_;
    bool is_first_pass_ = true;
    std::size_t jobs_ = 0;                         ///< of start()
    std::uint32_t in_flight_ = 1, first_pass_ = 0; ///< of the launch that is enqueued
    double seconds_ = 0;
};

} // namespace tetrace
