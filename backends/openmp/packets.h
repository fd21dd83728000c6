#pragma once

#include <cstdint>

namespace tetrace::openmp {

/// What given rays walk to: their first triangle, or that or their end, or the domain's boundary, through all
/// triangles.
enum class Goal { triangle, end, boundary };

/// The arguments of a packet kernel (packet/block.cpp): only pointers and numbers. The kernel is compiled for
/// processors with more instructions than the rest of the program needs, so the two may share no inline function.
struct PacketJob {
    const std::uint32_t* records; ///< PackedScene::tets of layout half32; if rays cross tets, without ends at triangles
    const std::uint32_t* triangles; ///< and the other arrays of that scene
    const float* lines;
    const std::uint32_t* entry_ranges;
    const std::uint32_t* entry_half_faces;
    std::uint32_t divisions;
    float origin[3], corner[3], step_x[3], step_y[3]; ///< of the view
    std::uint32_t width, height, start_tet, max_steps;
    std::uint32_t block_x, block_y;  ///< the first pixel of the block to trace, unless rays are given
    const std::uint32_t* directions; ///< quads of given rays, null if there are none: {direction, half-face}
    const std::uint32_t* origins;    ///< {origin, end or stretch}
    Goal goal;                       ///< `end` if any of them has one
    bool absorbs;                    ///< with goal `boundary`: the answers are those of task absorb
    std::uint32_t* sums;             ///< with goal `boundary`: two words a tet, to which lengths are added, or null
    bool starts_outside;             ///< whether any of them starts outside the domain
    std::uint32_t ray_count;         ///< number of given rays
    std::uint32_t* next_ray;         ///< the first ray that no thread has taken
    std::uint32_t* hits;             ///< HIT_WORDS a ray: of the block, its pixels row after row, or of all given rays
    /// Traces the ray of that number among these with the scalar kernel, and writes its hit.
    void (*trace_one)(const PacketJob& job, std::uint32_t number);
    /// The same with goal `boundary`. added: how many of its lengths that are not 0 have been added to the sums.
    void (*cross_one)(const PacketJob& job, std::uint32_t number, std::uint32_t added);
    const void* context;
};

/// Pixels along the side of a block, which one call traces. What it writes for pixels outside the image is not used.
inline constexpr std::uint32_t packet_block_size = 32;

/// Traces in packets of that many lanes: 16 need AVX-512 (F, BW, DQ, VL), 8 need AVX2, and 4 need no more than the
/// whole program.
using TracePackets = void(const PacketJob& job);
/// Traces the job's block of pixels.
extern "C" TracePackets tetrace_trace_block_4, tetrace_trace_block_8, tetrace_trace_block_16;
/// The work of each thread for given rays: traces rays until none is left; a lane takes a new ray when its ray has
/// ended.
extern "C" TracePackets tetrace_trace_rays_4, tetrace_trace_rays_8, tetrace_trace_rays_16;

} // namespace tetrace::openmp
