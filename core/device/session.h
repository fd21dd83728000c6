#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// The first check of every Backend::open. Throws Error{missing} if the device cannot be used, unsupported where the
/// kernel does not run on it.
void require_kernel(const Backend& backend, std::size_t device, const KernelId& kernel);

/// The packed scene of a kernel that reads one; call it after require_kernel(). Throws Error{internal} if it is not
/// packed in the kernel's layout.
[[nodiscard]] const PackedScene& packed_scene(const Backend& backend, std::size_t device, const KernelId& kernel,
                                              const SceneData& scene);

/// Bytes of the largest buffer that a session may make: the device's limit, or the options' if they set one; 0 is no
/// limit.
[[nodiscard]] std::uint64_t max_buffer(const Device& device, const SessionOptions& options);

/// Pixel rows of a tile: as the options say, else 8, by measurement (results/tiles.md).
[[nodiscard]] unsigned tile_height_of(const SessionOptions& options);

} // namespace tetrace
