#pragma once

// Vulkan 1.1 through its C++ bindings, which open libvulkan.so.1 at run time, own their handles and throw
// vk::SystemError; include this, never vulkan_raii.hpp.
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_raii.hpp>
