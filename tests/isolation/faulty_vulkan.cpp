// A Vulkan layer, between the loader and the drivers, that makes them misbehave: FAULTY_VULKAN is "<call> <how>", or
// "<call>:<n> <how>" for the n-th call of its kind. It serves one instance and one device at a time.
#include "tests/isolation/misbehaviour.h"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

using tetrace::test::fault_at;
using tetrace::test::misbehave;

namespace {

PFN_vkGetInstanceProcAddr next_instance = nullptr;
PFN_vkGetDeviceProcAddr next_device = nullptr;

// What follows this layer, asked for when instance and device are made: later the loader names the first layer.
struct {
    PFN_vkGetPhysicalDeviceProperties get_properties = nullptr;
    PFN_vkCreateDevice create_device = nullptr;
    PFN_vkCreateComputePipelines create_pipelines = nullptr;
    PFN_vkAllocateMemory allocate = nullptr;
    PFN_vkMapMemory map_memory = nullptr;
    PFN_vkQueueSubmit submit = nullptr;
    PFN_vkWaitForFences wait_for_fences = nullptr;
} next;

template <class Function, class Ask, class Owner>
void find_next(Function& function, Ask ask, Owner owner, const char* name)
{
    function = reinterpret_cast<Function>(ask(owner, name));
}

std::map<VkDeviceMemory, VkDeviceSize> allocated;
unsigned char* last_mapped = nullptr;
VkDeviceSize last_mapped_bytes = 0;

std::string fault(const char* call, int number)
{
    return misbehave(fault_at("FAULTY_VULKAN", call, number));
}

/// The codes that an API has for what may happen.
VkResult code_of(const std::string& how)
{
    if (how == "out-of-memory") return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (how == "lost") return VK_ERROR_DEVICE_LOST;
    return VK_SUCCESS;
}

/// The loader's link to what follows, in a chain of structures.
template <class Link>
Link* link_in(const void* chain, VkStructureType type)
{
    auto* link = const_cast<Link*>(static_cast<const Link*>(chain));
    while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO))
        link = const_cast<Link*>(static_cast<const Link*>(link->pNext));
    return link;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* memory,
                                               VkInstance* instance)
{
    static int calls = 0;
    auto* const link = link_in<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    if (const VkResult code = code_of(fault("load", ++calls)); code != VK_SUCCESS) return code;
    next_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next_instance(nullptr, "vkCreateInstance"));
    const VkResult code = create(info, memory, instance);
    if (code != VK_SUCCESS) return code;
    find_next(next.get_properties, next_instance, *instance, "vkGetPhysicalDeviceProperties");
    find_next(next.create_device, next_instance, *instance, "vkCreateDevice");
    return code;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* memory, VkDevice* device)
{
    auto* const link = link_in<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    next_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult code = next.create_device(physical, info, memory, device);
    if (code != VK_SUCCESS) return code;
    find_next(next.create_pipelines, next_device, *device, "vkCreateComputePipelines");
    find_next(next.allocate, next_device, *device, "vkAllocateMemory");
    find_next(next.map_memory, next_device, *device, "vkMapMemory");
    find_next(next.submit, next_device, *device, "vkQueueSubmit");
    find_next(next.wait_for_fences, next_device, *device, "vkWaitForFences");
    return code;
}

VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties)
{
    next.get_properties(device, properties);
    const std::string how = fault("version", 1);
    if (how == "future") properties->apiVersion = VK_MAKE_API_VERSION(0, 9, 9, 9);
    if (how == "past") properties->apiVersion = VK_API_VERSION_1_0;
    if (how == "rubbish") std::memset(properties->deviceName, 0x9b, sizeof properties->deviceName); // and no NUL
}

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* memory, VkPipeline* pipelines)
{
    static int calls = 0;
    if (const VkResult code = code_of(fault("build", ++calls)); code != VK_SUCCESS) return code;
    return next.create_pipelines(device, cache, count, infos, memory, pipelines);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory)
{
    static int calls = 0;
    if (const VkResult code = code_of(fault("memory", ++calls)); code != VK_SUCCESS) return code;
    const VkResult code = next.allocate(device, info, callbacks, memory);
    if (code == VK_SUCCESS) allocated[*memory] = info->allocationSize;
    return code;
}

VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                          VkDeviceSize size, VkMemoryMapFlags flags, void** data)
{
    const VkResult code = next.map_memory(device, memory, offset, size, flags, data);
    if (code == VK_SUCCESS) {
        last_mapped = static_cast<unsigned char*>(*data);
        last_mapped_bytes = allocated[memory];
    }
    return code;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence)
{
    static int calls = 0;
    if (count > 0) // an empty one serves only for its fence
        if (const VkResult code = code_of(fault("launch", ++calls)); code != VK_SUCCESS) return code;
    return next.submit(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_for_fences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all,
                                               uint64_t timeout)
{
    static int calls = 0;
    const std::string how = fault("wait", ++calls);
    if (const VkResult code = code_of(how); code != VK_SUCCESS) return code;
    const VkResult code = next.wait_for_fences(device, count, fences, all, timeout);
    // The output is what was mapped last.
    if (how == "garbage") std::memset(last_mapped + last_mapped_bytes / 2, 0x5a, last_mapped_bytes / 16);
    if (how == "nan") std::memset(last_mapped + last_mapped_bytes / 2, 0xff, last_mapped_bytes / 16);
    return code;
}

PFN_vkVoidFunction ours(std::string_view name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name)
{
    const auto found = ours(name);
    return found != nullptr ? found : next_device(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* name)
{
    const auto found = ours(name);
    return found != nullptr || next_instance == nullptr ? found : next_instance(instance, name);
}

PFN_vkVoidFunction ours(std::string_view name)
{
    const std::pair<std::string_view, PFN_vkVoidFunction> functions[] = {
        {"vkGetInstanceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(get_instance_function)},
        {"vkGetDeviceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(get_device_function)},
        {"vkCreateInstance", reinterpret_cast<PFN_vkVoidFunction>(create_instance)},
        {"vkCreateDevice", reinterpret_cast<PFN_vkVoidFunction>(create_device)},
        {"vkGetPhysicalDeviceProperties", reinterpret_cast<PFN_vkVoidFunction>(get_properties)},
        {"vkCreateComputePipelines", reinterpret_cast<PFN_vkVoidFunction>(create_pipelines)},
        {"vkAllocateMemory", reinterpret_cast<PFN_vkVoidFunction>(allocate)},
        {"vkMapMemory", reinterpret_cast<PFN_vkVoidFunction>(map_memory)},
        {"vkQueueSubmit", reinterpret_cast<PFN_vkVoidFunction>(submit)},
        {"vkWaitForFences", reinterpret_cast<PFN_vkVoidFunction>(wait_for_fences)}};
    for (const auto& [known, function] : functions)
        if (known == name) return function;
    return nullptr;
}

} // namespace

/// What the loader asks a layer for.
extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* layer)
{
    layer->loaderLayerInterfaceVersion = std::min(layer->loaderLayerInterfaceVersion, 2u);
    layer->pfnGetInstanceProcAddr = get_instance_function;
    layer->pfnGetDeviceProcAddr = get_device_function;
    layer->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
