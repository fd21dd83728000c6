// rt/: what Vulkan drivers provide for ray tracing: their own BVHs, and ray queries and pipelines that trace through
// them.
#pragma once

#include "backends/vulkan/buffer.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>

namespace tetrace::vulkan {

/// A triangle mesh as the driver's own BVH: a bottom level of its triangles, built for fast tracing and then compacted,
/// and a top level with one instance of it, without a transformation.
class Acceleration {
public:
    /// context: with a RayTracer. Throws Error{unsupported} with both numbers where the device's structures hold
    /// fewer triangles, or its memory is too small.
    Acceleration(const Context& context, const TriangleMesh& mesh);

    /// The top level, for shaders.
    [[nodiscard]] vk::AccelerationStructureKHR handle() const { return *top_.handle; }
    /// Bytes of both levels, compacted.
    [[nodiscard]] std::uint64_t bytes() const { return bottom_.memory.bytes() + top_.memory.bytes(); }
    /// Seconds of copying vertices and indices to the device, on the host's clock.
    [[nodiscard]] double upload_s() const { return upload_s_; }
    /// Seconds of building both levels and compacting, by timestamps.
    [[nodiscard]] double build_s() const { return build_s_; }

private:
    struct Level {
        Buffer memory; // outlives the handle
        vk::raii::AccelerationStructureKHR handle{nullptr};
    };
    [[nodiscard]] Level make_level(vk::AccelerationStructureTypeKHR type, std::uint64_t bytes) const;
    /// Builds a level of that many triangles or instances.
    [[nodiscard]] Level build(vk::AccelerationStructureTypeKHR type,
                              const vk::AccelerationStructureGeometryKHR& geometry, std::uint32_t count);
    [[nodiscard]] Level build_bottom(const TriangleMesh& mesh);
    [[nodiscard]] Level build_top();
    [[nodiscard]] Level compacted(const Level& level);
    [[nodiscard]] std::uint64_t compacted_bytes(const Level& level) const;
    [[nodiscard]] Buffer uploaded(std::span<const std::byte> bytes);
    /// Submits what `record` records, waits, and counts its time as building.
    template <class Record>
    void run_timed(const Record& record);

    const Context* context_; ///< the session's, which outlives this
    double upload_s_ = 0, build_s_ = 0;
    Level bottom_, top_;
};

} // namespace tetrace::vulkan
