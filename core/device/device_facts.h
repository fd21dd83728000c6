#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// How devices are named, the same under each API, so that one device under several APIs is known as one.

/// What stands for the devices that an API has not, with the reason why.
[[nodiscard]] Device unusable_device(const std::string& name, const std::string& reason);

/// Two lower-case digits a byte: Device::uuid.
[[nodiscard]] std::string hexadecimal(std::span<const std::uint8_t> bytes);

/// "0000:41:00.0": Device::pci.
[[nodiscard]] std::string pci_address(unsigned domain, unsigned bus, unsigned device, unsigned function);

/// UUID, else PCI address, else name: Device::id.
[[nodiscard]] std::string id_of(const Device& device);

/// Device::implementation, in short: a driver's name in lower case, its words joined by dashes, and the first two
/// numbers of its version, of NVIDIA's the first. "Mesa 22.3.6 (LLVM 15.0.6)" is version 22.3; a text without digits
/// is none and left out. A name without letters and digits is "unknown".
[[nodiscard]] std::string implementation_name(std::string_view driver, std::string_view version);

/// The facts of what an API found, in its order.
template <class Found>
[[nodiscard]] std::vector<Device> facts_of(const std::vector<Found>& found)
{
    std::vector<Device> devices;
    for (const Found& device : found)
        devices.push_back(device.facts);
    return devices;
}

} // namespace tetrace
