#pragma once

#include "core/pack/kernel_id.h"

#include <string>
#include <string_view>

namespace tetrace::webgpu {

/// Binding of the launch's words, LaunchWords of kernel.h, in every kernel; outputs have OUTPUT_BINDING.
inline constexpr unsigned launch_binding = TETRACE_WEBGPU_LAUNCH_BINDING;

/// Binding of the sums of task tally (sums.wgsl); given rays have RAYS_BINDING.
inline constexpr unsigned sums_binding = 17;

/// The WGSL of a kernel in exact mode; empty if the build has none of that method, layout and task.
[[nodiscard]] std::string_view kernel_text(const KernelId& kernel);

/// The WGSL of the self-test.
[[nodiscard]] std::string_view probe_text();

/// The page that runs kernels in a browser (page.html), with "@SCRIPT@" and "@DATA@" in place of its script and data.
[[nodiscard]] std::string_view page_text();
/// The script of that page (page.js).
[[nodiscard]] std::string_view page_script();

} // namespace tetrace::webgpu
