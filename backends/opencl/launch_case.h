#pragma once

#include "core/device/defects.h"
#include "core/device/launch.h"

#include <span>
#include <string_view>

namespace tetrace::opencl {

/// Backend::tile_case().
[[nodiscard]] LaunchCase tile_case(const Device& device, const KernelId& kernel, const PackedScene& scene,
                                   const LaunchParams& launch, std::span<const Quad> rays,
                                   const std::filesystem::path& program_file);

/// Backend::defect_case().
[[nodiscard]] LaunchCase defect_case(std::string_view name, const DefectLaunch& launch);

} // namespace tetrace::opencl
