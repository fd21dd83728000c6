#pragma once

#include "backends/webgpu/wgsl/tokens.h"

#include <string>
#include <string_view>

namespace tetrace::wgsl {

/// WGSL of a kernel's text in the kernels' subset of C, preprocessed with kernels/language/dialect_wgsl.h. The subset,
/// and what becomes of it: docs/spec/wgsl.md. In expressions of precise locals each rounded value goes through keep()
/// and each division through divided(), both of prelude.wgsl, because WGSL promises neither an order of operations nor
/// a correctly rounded division.
/// Throws TranslationError, which names file and line, for everything outside the subset.
[[nodiscard]] std::string translate(std::string_view preprocessed);

} // namespace tetrace::wgsl
