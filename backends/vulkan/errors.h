#pragma once

#include "backends/vulkan/api.h"
#include "core/base/error.h"

#include <cstdint>
#include <string>

namespace tetrace::vulkan {

/// Whether the code means that memory is too small.
[[nodiscard]] bool is_about_memory(vk::Result code);

/// What was being done when the API failed, for the error's text.
struct Doing {
    std::string doing;              ///< "launching"
    std::string device;             ///< its name
    std::uint64_t bytes = 0;        ///< that the work needs on the device
    std::uint64_t memory_bytes = 0; ///< of the device
};

/// unsupported with both numbers where memory does not suffice, else internal; both name call, code and device.
[[nodiscard]] Error to_error(const vk::SystemError& failure, const Doing& task);

} // namespace tetrace::vulkan
