#pragma once

#include "core/device/launch.h"
#include "core/pack/packed_scene.h"

#include <array>
#include <barrier>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tetrace::test {

/// A warp whose lanes are threads of the host: all of them meet at each vote and each shuffle.
class Warp {
public:
    static constexpr std::uint32_t lanes = 32;

    /// Bit i of the result is lane i's vote.
    std::uint32_t ballot(std::uint32_t lane, bool vote);
    /// What lane `from` brings. Lanes fetch by it (kernels/bvh/refill_cuda.h).
    std::uint32_t shuffle(std::uint32_t lane, std::uint32_t value, std::uint32_t from);
    /// How often lanes fetched while others of the warp went on with their rays.
    [[nodiscard]] std::size_t refills() const { return refills_; }

private:
    std::array<std::uint32_t, lanes> exchange(std::uint32_t lane, std::uint32_t word);

    std::array<std::uint32_t, lanes> words_{};
    std::uint32_t last_vote_ = 0; ///< of lane 0, as refills_ is
    std::size_t refills_ = 0;
    std::barrier<> meeting_{lanes};
};

/// What CUDA's persistent entry is launched with.
struct WarpLaunch {
    const PackedScene& packed;
    const LaunchParams& params;
    std::span<const Quad> rays; ///< given ones; empty: the image's
    std::span<std::uint32_t> output;
};

/// Runs backends/cuda/kernel.cu by a block of several warps. Returns the sum of their refills.
std::size_t trace_by_warps_bvh2(const WarpLaunch& launch);
std::size_t trace_by_warps_cwbvh(const WarpLaunch& launch);

} // namespace tetrace::test
