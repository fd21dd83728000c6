#pragma once

#include "core/pack/packed_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// An array as a layout's kernels read it. An array that they read both as words and as quads has two entries.
struct SceneArray {
    const char* name;
    std::uint32_t binding;
    std::uint32_t element_bytes; ///< 4 or 16
};
/// In the order of kernels/layouts/cdt_arrays.h, compact_arrays.h or bvh_arrays.h.
[[nodiscard]] std::span<const SceneArray> scene_arrays(Layout layout);

/// An array of a packed scene as the bytes that are copied to a device.
struct SceneBuffer {
    const char* name;
    std::span<const std::byte> bytes;
};
/// All arrays of the scene's layout by their binding; at most SCENE_ARRAYS.
[[nodiscard]] std::vector<SceneBuffer> scene_buffers(const PackedScene& scene);

/// How the array of tets is cut if it exceeds a device's largest buffer: parts of 2^log2_bytes, the last one shorter.
struct TetParts {
    unsigned count = 1;
    unsigned log2_bytes = 31;
    [[nodiscard]] std::span<const std::byte> part(std::span<const std::byte> tets, unsigned index) const;
};
/// max_buffer_bytes: of the device; 0 is not a limit. One part where the array fits.
/// Throws Error{unsupported} naming the array and both numbers where any other array exceeds it, any array of a BVH
/// does, or the tets need more than MAX_TET_PARTS parts.
[[nodiscard]] TetParts tet_parts(const PackedScene& scene, std::uint64_t max_buffer_bytes);

} // namespace tetrace
