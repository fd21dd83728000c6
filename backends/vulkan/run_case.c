/* Runs the launch of case.h on a Vulkan device, and compares its output. `tetrace dump` wrote both.
 * Build and run:  cc -O1 -o run_case run_case.c -l:libvulkan.so.1 && ./run_case [TEXT]
 * TEXT: a part of the device's name. Without it, the first device.
 * Exit code: 0, the output is the expected one; 1, it differs; 2, the case cannot run here. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#include "case.h"

enum kind { buffer, words, quads }; /* words, quads: a buffer that is read as texels */
static const struct {
    enum kind kind;
    uint32_t binding;
    const char* file;
} inputs[] = {INPUTS};
static const uint32_t constants[] = {CONSTANTS}; /* of specialization, by ID; a module that has their values ignores them */
static const uint32_t pushed[] = {PUSHED};

enum { INPUT_COUNT = sizeof(inputs) / sizeof(inputs[0]), CONSTANT_COUNT = sizeof(constants) / sizeof(constants[0]) };

static VkPhysicalDevice physical;
static VkDevice device;
static VkDescriptorSet set;

/* Positive codes are no errors. */
static void check(VkResult code, const char* what)
{
    if (code >= 0) return;
    fprintf(stderr, "run_case: %s: %d\n", what, code);
    exit(2);
}

static void require(int holds, const char* problem, const char* of)
{
    if (holds) return;
    fprintf(stderr, "run_case: %s %s\n", problem, of);
    exit(2);
}

static void* read_file(const char* name, size_t* bytes)
{
    FILE* file = fopen(name, "rb");
    require(file != NULL && fseek(file, 0, SEEK_END) == 0, "cannot read", name);
    *bytes = (size_t)ftell(file);
    rewind(file);
    char* contents = calloc(*bytes + 1, 1);
    require(contents != NULL && fread(contents, 1, *bytes, file) == *bytes, "cannot read", name);
    fclose(file);
    return contents;
}

/* Of Vulkan 1.1, with this text in its name. */
static void find_device(const char* text)
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_1};
    VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0, &application};
    VkInstance instance;
    check(vkCreateInstance(&info, NULL, &instance), "vkCreateInstance");
    VkPhysicalDevice devices[64];
    uint32_t count = 64;
    check(vkEnumeratePhysicalDevices(instance, &count, devices), "vkEnumeratePhysicalDevices");
    for (uint32_t i = 0; i < count && physical == NULL; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (properties.apiVersion < VK_API_VERSION_1_1 || strstr(properties.deviceName, text) == NULL) continue;
        printf("%s, driver 0x%x\n", properties.deviceName, properties.driverVersion);
        physical = devices[i];
    }
    require(physical != NULL, "no device of Vulkan 1.1 has in its name:", text);
}

/* A buffer that the host writes and reads in place. */
static VkBuffer make_buffer(size_t bytes, void** mapped)
{
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, NULL, 0, bytes < 16 ? 16 : bytes};
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    VkBuffer made;
    check(vkCreateBuffer(device, &info, NULL, &made), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, made, &needs);
    VkPhysicalDeviceMemoryProperties memories;
    vkGetPhysicalDeviceMemoryProperties(physical, &memories);
    const VkFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo allocation = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
    while (!(needs.memoryTypeBits >> allocation.memoryTypeIndex & 1) ||
           (memories.memoryTypes[allocation.memoryTypeIndex].propertyFlags & wanted) != wanted)
        require(++allocation.memoryTypeIndex != memories.memoryTypeCount, "no memory fits", "a buffer");
    VkDeviceMemory memory;
    check(vkAllocateMemory(device, &allocation, NULL, &memory), "vkAllocateMemory");
    check(vkBindBufferMemory(device, made, memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, mapped), "vkMapMemory");
    return made;
}

static VkDescriptorType type_of(enum kind kind)
{
    return kind == buffer ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
}

/* Makes a buffer of the set. Returns its memory. */
static void* bind_buffer(enum kind kind, uint32_t binding, size_t bytes)
{
    void* mapped;
    VkDescriptorBufferInfo whole = {make_buffer(bytes, &mapped), 0, VK_WHOLE_SIZE};
    const VkFormat format = kind == quads ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32_UINT;
    VkBufferViewCreateInfo info = {
        VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO, NULL, 0, whole.buffer, format, 0, VK_WHOLE_SIZE};
    VkBufferView view = VK_NULL_HANDLE;
    if (kind != buffer) check(vkCreateBufferView(device, &info, NULL, &view), "vkCreateBufferView");
    VkWriteDescriptorSet write = {
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, NULL, set, binding, 0, 1, type_of(kind), NULL, &whole, &view};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    return mapped;
}

/* Makes the set, and the layout of a pipeline with it. */
static VkPipelineLayout make_layout(void)
{
    VkDescriptorSetLayoutBinding bindings[INPUT_COUNT + 2] = {
        {OUTPUT, type_of(buffer), 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    VkDescriptorSetLayoutCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, NULL, 0, 1, bindings};
    for (size_t i = 0; i < INPUT_COUNT; ++i)
        bindings[info.bindingCount++] = (VkDescriptorSetLayoutBinding){inputs[i].binding, type_of(inputs[i].kind), 1,
                                                                       VK_SHADER_STAGE_COMPUTE_BIT, NULL};
#ifdef LARGE_BYTES /* a buffer that only the program sees */
    bindings[info.bindingCount++] =
        (VkDescriptorSetLayoutBinding){2, type_of(buffer), 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL};
#endif
    VkDescriptorSetLayout set_layout;
    check(vkCreateDescriptorSetLayout(device, &info, NULL, &set_layout), "vkCreateDescriptorSetLayout");
    const VkDescriptorPoolSize sizes[] = {{type_of(buffer), INPUT_COUNT + 2}, {type_of(words), INPUT_COUNT}};
    VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, NULL, 0, 1, 2, sizes};
    VkDescriptorPool pool;
    check(vkCreateDescriptorPool(device, &pool_info, NULL, &pool), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, NULL, pool, 1, &set_layout};
    check(vkAllocateDescriptorSets(device, &set_info, &set), "vkAllocateDescriptorSets");
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed)};
    VkPipelineLayoutCreateInfo layout_info = {
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, NULL, 0, 1, &set_layout, 1, &range};
    VkPipelineLayout layout;
    check(vkCreatePipelineLayout(device, &layout_info, NULL, &layout), "vkCreatePipelineLayout");
    return layout;
}

static VkPipeline make_pipeline(VkPipelineLayout layout)
{
    VkSpecializationMapEntry entries[CONSTANT_COUNT];
    for (uint32_t i = 0; i < CONSTANT_COUNT; ++i)
        entries[i] = (VkSpecializationMapEntry){i, 4 * i, 4};
    VkSpecializationInfo values = {CONSTANT_COUNT, entries, sizeof(constants), constants};
    VkShaderModuleCreateInfo module_info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module_info.pCode = read_file(PROGRAM, &module_info.codeSize);
    VkShaderModule module;
    check(vkCreateShaderModule(device, &module_info, NULL, &module), "vkCreateShaderModule");
    VkPipelineShaderStageCreateInfo stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                             NULL,
                                             0,
                                             VK_SHADER_STAGE_COMPUTE_BIT,
                                             module,
                                             "main",
                                             &values};
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, NULL, 0, stage, layout};
    VkPipeline pipeline;
    check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), "vkCreateComputePipelines");
    return pipeline;
}

static void run(uint32_t family, VkPipelineLayout layout)
{
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, family};
    VkCommandPool pool;
    check(vkCreateCommandPool(device, &pool_info, NULL, &pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool,
                                        VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, make_pipeline(layout));
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, NULL);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), pushed);
    vkCmdDispatch(commands, GROUPS, 1, 1);
    VkMemoryBarrier barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_SHADER_WRITE_BIT,
                               VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         NULL, 0, NULL);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkQueue queue;
    vkGetDeviceQueue(device, family, 0, &queue);
    VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
}

static int compare(const uint32_t* found)
{
    size_t bytes, more, wrong = 0;
    const uint32_t* wanted = read_file("expected.bin", &bytes);
    const uint32_t* tolerances = read_file("tolerance.bin", &more);
    require(bytes == 4 * OUTPUT_WORDS && more == bytes, "wrong size of", "expected.bin or tolerance.bin");
    for (size_t i = 0; i < OUTPUT_WORDS; ++i) {
        const uint32_t a = found[i], b = wanted[i];
        if ((a > b ? a - b : b - a) <= tolerances[i]) continue;
        if (wrong++ == 0) printf("word %zu is %u (0x%08x) instead of %u (0x%08x)\n", i, a, a, b, b);
    }
    printf("%zu of %d words differ\n", wrong, OUTPUT_WORDS);
    return wrong != 0;
}

int main(int argc, char** argv)
{
    find_device(argc > 1 ? argv[1] : "");
    VkQueueFamilyProperties families[64];
    uint32_t count = 64, family = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    while (!(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT))
        require(++family != count, "no queue computes on", "the device");
    const float priority = 1;
    VkDeviceQueueCreateInfo queue = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, family, 1, &priority};
    VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, NULL, 0, 1, &queue};
    check(vkCreateDevice(physical, &info, NULL, &device), "vkCreateDevice");

    const VkPipelineLayout layout = make_layout();
    for (size_t i = 0, bytes; i < INPUT_COUNT; ++i) {
        const void* contents = read_file(inputs[i].file, &bytes);
        memcpy(bind_buffer(inputs[i].kind, inputs[i].binding, bytes), contents, bytes);
    }
#ifdef LARGE_BYTES
    bind_buffer(buffer, 2, LARGE_BYTES);
#endif
    uint32_t* output = bind_buffer(buffer, OUTPUT, 4 * OUTPUT_WORDS);
    for (size_t i = 0; i < OUTPUT_WORDS; ++i)
        output[i] = OUTPUT_BEFORE;
    run(family, layout);
    return compare(output);
}
