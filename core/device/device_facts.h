#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

// Devices have the same names under each API, so that one device under several APIs can be recognised.
/// The placeholder for an API without devices, with the reason.
[[nodiscard]] Device unusable_device(const std::string& name, const std::string& reason);

/// The path of the shared library that holds a function, without links; empty if none does. Device::library.
[[nodiscard]] std::string library_holding(const void* function);

/// Two lower-case digits per byte: Device::uuid.
[[nodiscard]] std::string hexadecimal(std::span<const std::uint8_t> bytes);

/// "0000:41:00.0": Device::pci.
[[nodiscard]] std::string pci_address(unsigned domain, unsigned bus, unsigned device, unsigned function);

/// UUID, else PCI address, else name: Device::id.
[[nodiscard]] std::string id_of(const Device& device);

/// Whether two descriptions can be of one device through one driver: name, driver, UUID and PCI address are equal. Two
/// devices of one model without UUID and PCI address are described alike, too.
[[nodiscard]] bool is_same_device(const Device& a, const Device& b);

/// Device::implementation: a driver's name in lower case, its words joined by dashes, and the first two numbers of its
/// version; for NVIDIA's driver only the first. Its three APIs have different compilers, so they have different names.
/// "Mesa 22.3.6 (LLVM 15.0.6)" is version 22.3; a text without digits gives no version. A name without letters and
/// digits is "unknown".
[[nodiscard]] std::string implementation_name(std::string_view driver, std::string_view version);

/// The device with texts that any terminal and any result can have, whatever its driver calls itself.
[[nodiscard]] Device printable(Device device);

/// The facts of the devices that an API found, in the API's order, printable.
template <class Found>
[[nodiscard]] std::vector<Device> facts_of(const std::vector<Found>& found)
{
    std::vector<Device> devices;
    for (const Found& device : found)
        devices.push_back(printable(device.facts));
    return devices;
}

} // namespace tetrace
