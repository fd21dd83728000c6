#include "backends/vulkan/errors.h"

namespace tetrace::vulkan {

bool is_about_memory(vk::Result code)
{
    return code == vk::Result::eErrorOutOfDeviceMemory || code == vk::Result::eErrorOutOfHostMemory ||
           code == vk::Result::eErrorOutOfPoolMemory;
}

Error to_error(const vk::SystemError& failure, const Doing& task)
{
    // The bindings' text is the call and the code: "vk::Queue::submit: ErrorDeviceLost".
    const std::string what = task.doing + " on '" + task.device + "': " + failure.what();
    if (!is_about_memory(static_cast<vk::Result>(failure.code().value())))
        return {ErrorKind::driver, what + "; the device's driver failed or the device was lost"};
    return {ErrorKind::unsupported, what + "; " + std::to_string(task.bytes) + " bytes are needed, the device has " +
                                        std::to_string(task.memory_bytes) +
                                        "; use a smaller scene, layout or image, or fewer rows at a time"};
}

} // namespace tetrace::vulkan
