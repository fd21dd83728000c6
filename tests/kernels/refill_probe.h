#pragma once

#include "core/device/launch.h"
#include "core/pack/packed_scene.h"

#include <array>
#include <barrier>
#include <cstddef>
#include <cstdint>
#include <list>
#include <span>

namespace tetrace::test {

/// What a lane, or a warp, has gone through.
struct Visits {
    std::size_t nodes = 0;
    std::size_t triangles = 0;
};

/// A warp whose lanes are threads of the host: those that a vote or a shuffle names meet at it.
class Warp {
public:
    static constexpr std::uint32_t lanes = 32;

    Warp();
    /// The warp's next votes are those of this thread, as lane `lane`.
    void join(std::uint32_t lane);
    /// Bit i of the result is lane i's vote. named: the lanes that vote, one bit each.
    std::uint32_t ballot(std::uint32_t named, bool vote);
    /// The value of lane `from`; of all lanes. Lanes fetch by it (kernels/bvh/refill_cuda.h).
    std::uint32_t shuffle(std::uint32_t value, std::uint32_t from);

    /// How often lanes fetched while others of the warp went on with their rays.
    [[nodiscard]] std::size_t refills() const { return refills_; }
    /// What lanes in lockstep go through: from one vote to the next, the most nodes of a lane, and the most triangles.
    [[nodiscard]] Visits visits() const { return visits_; }

    /// The calling lane's visits since its last vote.
    static thread_local Visits since_vote;

private:
    std::array<std::uint32_t, lanes> exchange(std::uint32_t named, std::uint32_t word);

    std::array<std::uint32_t, lanes> words_{};
    std::array<Visits, lanes> lane_visits_{};
    std::list<std::barrier<>> meetings_; ///< the first is of 1 lane, the next of 2, and so on
    std::uint32_t last_vote_ = 0;        ///< as refills_ and visits_, written by the first of the lanes that vote
    std::size_t refills_ = 0;
    Visits visits_;
};

/// What lanes wait for; as devices do, or the contrary.
struct Patience {
    std::uint32_t enough_lanes = 20; ///< have a ray, or the others fetch one; 1: fetch for whole warps
    bool puts_triangles_off = true;  ///< where few lanes have one (cwbvh)
};

/// What CUDA's persistent entry is launched with.
struct WarpLaunch {
    const PackedScene& packed;
    const LaunchParams& params;
    std::span<const Quad> rays; ///< given ones; empty: the image's
    std::span<std::uint32_t> output;
    std::uint32_t warps = 2;
    Patience patience = {};
};

/// Of all warps of a block.
struct WarpCounts {
    std::size_t refills = 0;
    Visits visits;
};

/// Runs backends/cuda/kernel.cu by a block of several warps.
WarpCounts trace_by_warps_bvh2(const WarpLaunch& launch);
WarpCounts trace_by_warps_bvh4(const WarpLaunch& launch);
WarpCounts trace_by_warps_cwbvh(const WarpLaunch& launch);

} // namespace tetrace::test
