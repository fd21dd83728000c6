#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// The machine's processor as a device: model name, memory; the caller adds driver and threads.
[[nodiscard]] Device host_device();

/// Whether the processor runs code compiled for x86-64-v3 (AVX2 and fused multiply-add); true on other architectures,
/// whose baseline has fused instructions.
[[nodiscard]] bool host_has_fused_multiply();

} // namespace tetrace
