#pragma once

#include "backends/vulkan/api.h"

#include <string>
#include <vector>

namespace tetrace::vulkan {

/// A device as a driver lists it without the loader.
struct DriverDevice {
    VkPhysicalDeviceProperties properties;
    std::string library; ///< Device::library
};

/// The devices of the drivers whose libraries are loaded, each asked through an instance of its own: the loader does
/// not say which driver a device is from. Throws nothing. Source: "Loader and Driver Interface", Khronos.
[[nodiscard]] std::vector<DriverDevice> driver_devices();

/// The library of the driver that lists such a device: of that name and of that build of the driver. Empty if none
/// does.
[[nodiscard]] std::string library_of(const std::vector<DriverDevice>& devices,
                                     const VkPhysicalDeviceProperties& properties);

} // namespace tetrace::vulkan
