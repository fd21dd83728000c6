#pragma once

#include "core/device/backend.h"
#include "core/device/self_test.h"

#include <optional>

namespace tetrace {

/// The device's self-test in a math mode, run at the first call and kept; empty if the API runs none of our kernels.
/// Throws Error if the device fails.
[[nodiscard]] const std::optional<SelfTest>& self_test_of(Backend& backend, std::size_t device, MathMode math);

/// The device's microbenchmark, run at the first call and kept; empty if the API has none of its own.
/// options: those of the rows. Throws Error if the device fails.
[[nodiscard]] const std::optional<Yardstick>& yardstick_of(Backend& backend, std::size_t device,
                                                           const SessionOptions& options);

} // namespace tetrace
