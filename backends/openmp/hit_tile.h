#pragma once

#include "backends/openmp/packets.h"
#include "core/rays/hit.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tetrace::openmp {

/// The hits of a block of pixels, traced in the near caches before they go to their image. Where the processor can,
/// they then go past its caches, a line at a time: no line of the image is read first, and none pushes out what rays
/// need.
class HitTile {
public:
    /// image: width x height hits, row after row. Other threads see them once this object is gone.
    HitTile(std::span<Hit> image, std::uint32_t width, std::uint32_t height);
    HitTile(const HitTile&) = delete;
    HitTile& operator=(const HitTile&) = delete;
    ~HitTile();

    /// packet_block_size rows of as many hits.
    [[nodiscard]] std::span<Hit> hits() { return hits_; }

    /// Stores them with the first at (x, y) of the image. Hits outside the image are left out.
    void store(std::uint32_t x, std::uint32_t y) const;

private:
    std::span<Hit> image_;
    std::uint32_t width_, height_;
    alignas(64) std::array<Hit, std::size_t{packet_block_size} * packet_block_size> hits_{};
};

} // namespace tetrace::openmp
