#pragma once

#include "backends/opencl/context.h"
#include "backends/opencl/program.h"
#include "core/device/defects.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tetrace::opencl {

/// Runs kernels/probe.h, one item and one result per quad. Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_probe(Context& context, MathMode math, std::span<const Quad> operations);

/// The program of a reduced kernel (core/device/defects.h).
[[nodiscard]] ProgramId defect_program(std::string_view name);

/// Compiles and runs a reduced kernel. Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_defect(Context& context, std::string_view name,
                                                    const DefectLaunch& launch);

/// Copy bandwidth of the device's memory and caches by clEnqueueCopyBuffer and its events (core/device/yardstick.h),
/// buffers of 512 MiB at most, less where one may not be that large, bytes read and written; and the median time of an
/// empty kernel from its enqueueing to the end of clFinish on the host's clock. Throws Error if the device fails.
[[nodiscard]] Yardstick measure_device(Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::opencl
