#pragma once

#include "backends/vulkan/context.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace::vulkan {

/// Runs kernels/probe.h, one item and one result per quad. Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_probe(const Context& context, MathMode math,
                                                   std::span<const Quad> operations);

} // namespace tetrace::vulkan
