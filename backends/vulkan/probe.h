#pragma once

#include "backends/vulkan/context.h"
#include "core/device/defects.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace::vulkan {

/// Runs kernels/probe.h, one item and one result per quad. Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_probe(const Context& context, MathMode math,
                                                   std::span<const Quad> operations);

} // namespace tetrace::vulkan

// defects/: reduced kernels of compilers' defects as Vulkan programs.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace::vulkan {

/// Compiles and runs a reduced kernel (core/device/defects.h). Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_defect(const Context& context, std::string_view name,
                                                    const DefectLaunch& launch);

/// Copy bandwidth of the device's memory and caches by vkCmdCopyBuffer and timestamps (core/device/yardstick.h),
/// buffers of 512 MiB at most, less where one may not be that large, bytes read and written; and the median time of an
/// empty kernel from vkQueueSubmit to its fence on the host's clock. Throws Error if the device fails.
[[nodiscard]] Yardstick measure_device(const Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::vulkan
