#pragma once

#include "backends/openmp/packets.h"
#include "core/device/host.h"
#include "core/rays/hit.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tetrace::openmp {

/// The hits of a block of pixels, traced in the near caches before they go to their image. If the processor can,
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

/// A width that packets are compiled for, and their kernel.
struct PacketKernel {
    unsigned lanes;
    TracePackets* block;
    TracePackets* rays;
};
/// The widths that this build has and this processor runs, the widest first; never empty.
[[nodiscard]] const std::vector<PacketKernel>& packet_kernels();
/// The kernel with that many lanes; 0: the widest. Throws Error{unsupported}, which says why it is missing and which
/// widths there are.
[[nodiscard]] PacketKernel packet_kernel(unsigned lanes);

/// Schedule packets: traces packets of primary or given rays through layout half32, or lets given rays cross its tets.
/// Answers and sums are the same bits as with schedule tiles.
class PacketSession : public HostSession {
public:
    PacketSession(PacketKernel kernel, Task task, const PackedScene& scene, unsigned threads);
    void set_rays(std::span<const Quad> quads) override;
    [[nodiscard]] SetupTimes setup_times() const override;
    [[nodiscard]] std::uint64_t bytes() const override { return scene_.bytes(); }

private:
    struct Free {
        void operator()(void* block) const { std::free(block); }
    };

    void run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles) override;

    PacketKernel kernel_;
    Task task_;
    const PackedScene& scene_;
    double copy_s_ = 0;
    std::vector<Quad> rays_;
    bool rays_end_ = false;                        ///< any of them
    bool rays_start_outside_ = false;              ///< any of them
    std::unique_ptr<std::uint32_t, Free> records_; ///< aligned so that no record crosses a cache line, on huge pages
};

} // namespace tetrace::openmp
