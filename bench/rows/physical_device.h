#pragma once

#include "core/device/backend.h"
#include "core/device/self_test.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tetrace {

/// Whether the device computes on the host's own processor.
[[nodiscard]] bool runs_on_host(const Device& device);

/// The piece of hardware of each device, across all APIs: equal numbers mean the same piece, counted from 0 in order of
/// first appearance. Usable devices on the host are one piece. Other devices are one piece where their UUIDs are equal
/// or, if one of them has no UUID, their PCI addresses. A device that cannot be used and has neither is a piece of its
/// own: it represents what is missing.
[[nodiscard]] std::vector<std::size_t> physical_devices(std::span<const Device> devices);

/// The device's self-test in a math mode, run at the first call and kept; empty if the API runs none of our kernels.
/// Throws Error if the device fails.
[[nodiscard]] const std::optional<SelfTest>& self_test_of(Backend& backend, std::size_t device, MathMode math);

/// The device's microbenchmark, run at the first call and kept; empty if the API has none of its own.
/// options: those of the rows. Throws Error if the device fails.
[[nodiscard]] const std::optional<Yardstick>& yardstick_of(Backend& backend, std::size_t device,
                                                           const SessionOptions& options);

} // namespace tetrace
