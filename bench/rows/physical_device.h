#pragma once

#include "core/device/backend.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tetrace {

/// Whether the device computes on the host's own processor.
[[nodiscard]] bool runs_on_host(const Device& device);

/// The piece of hardware that each device, of whatever APIs, is: equal numbers are one piece, counted from 0 in the
/// order of first appearance. Usable devices on the host are one; others are one where their UUIDs are equal or, where
/// one of them has none, their PCI addresses. A device that cannot be used and has neither is a piece of its own: it
/// stands for what is missing.
[[nodiscard]] std::vector<std::size_t> physical_devices(std::span<const Device> devices);

} // namespace tetrace
