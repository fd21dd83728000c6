#include "backends/vulkan/instance.h"

#include "core/base/error.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace tetrace::vulkan {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

bool validation_is_wanted()
{
#ifdef TETRACE_VULKAN_VALIDATES
    return true;
#else
    const char* const asked = std::getenv("TETRACE_VULKAN_VALIDATION");
    return asked != nullptr && std::string_view(asked) == "1";
#endif
}

bool has_validation_layer(const vk::raii::Context& loader)
{
    const auto layers = loader.enumerateInstanceLayerProperties();
    return std::ranges::any_of(layers, [](const vk::LayerProperties& layer) {
        return std::string_view(layer.layerName.data()) == validation_layer;
    });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* log)
{
    static_cast<ValidationLog*>(log)->add(data->pMessage);
    return VK_FALSE;
}

/// As a raw structure: the callback's type in the bindings differs between versions.
vk::DebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog& log)
{
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = &log;
    return info;
}

std::unique_ptr<vk::raii::Context> open_loader()
{
    try {
        return std::make_unique<vk::raii::Context>();
    } catch (const std::exception&) {
        const char* const why = ::dlerror(); // the bindings do not say
        throw Error(ErrorKind::missing, "the Vulkan loader libvulkan.so.1 cannot be opened" +
                                            (why != nullptr ? std::string(": ") + why : std::string()) +
                                            "; install libvulkan1 and the GPU's driver, or mesa-vulkan-drivers");
    }
}

} // namespace

void ValidationLog::add(const std::string& message)
{
    const std::lock_guard lock(mutex_);
    if (!messages_.empty()) messages_ += '\n';
    messages_ += message;
}

std::string ValidationLog::take()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

Instance::Instance() : loader_(open_loader())
{
    try {
        validates_ = validation_is_wanted() && has_validation_layer(*loader_);
        make();
    } catch (const vk::SystemError& failure) {
        throw Error(ErrorKind::driver, std::string("making a Vulkan instance: ") + failure.what() +
                                           "; a driver is needed: the GPU's, or the package mesa-vulkan-drivers");
    }
}

void Instance::make()
{
    const auto application = vk::ApplicationInfo{}.setPApplicationName("tetrace").setApiVersion(VK_API_VERSION_1_1);
    auto info = vk::InstanceCreateInfo{}.setPApplicationInfo(&application);
    const std::array layers = {validation_layer};
    const std::array extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const std::array enabled = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const auto features = vk::ValidationFeaturesEXT{}.setEnabledValidationFeatures(enabled);
    if (validates_) info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions).setPNext(&features);
    handle_ = std::make_unique<vk::raii::Instance>(*loader_, info);
    if (validates_) messenger_ = std::make_unique<vk::raii::DebugUtilsMessengerEXT>(*handle_, messenger_info(*log_));
}

Instance& instance()
{
    static Instance* const made = new Instance;
    return *made;
}

} // namespace tetrace::vulkan
