#pragma once

#include "core/packed_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tetrace {

/// An array of a packed scene as the bytes that a device is given.
struct SceneBuffer {
    const char* name;
    std::span<const std::byte> bytes;
};
/// All arrays by their binding (kernels/scene_arrays.h).
[[nodiscard]] std::array<SceneBuffer, SCENE_ARRAYS> scene_buffers(const PackedScene& scene);

/// How the array of tets is cut where it exceeds a device's largest buffer: parts of 2^log2_bytes, the last one
/// shorter.
struct TetParts {
    unsigned count = 1;
    unsigned log2_bytes = 31;
    [[nodiscard]] std::span<const std::byte> part(std::span<const std::byte> tets, unsigned index) const;
};
/// max_buffer_bytes: of the device; 0 is no limit. One part where the array fits.
/// Throws Error{unsupported} naming the array and both numbers where another array exceeds it, or MAX_TET_PARTS do.
[[nodiscard]] TetParts tet_parts(const PackedScene& scene, std::uint64_t max_buffer_bytes);

} // namespace tetrace
