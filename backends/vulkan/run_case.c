/* Runs the launch that case.txt describes on a Vulkan device, and compares its output. `tetrace dump` wrote both.
 * Build and run:  cc -O1 -o run_case run_case.c -l:libvulkan.so.1 && ./run_case [TEXT]
 * TEXT: a part of the device's name. Without it, the first device.
 * Exit code: 0, the output is the expected one; 1, it differs; 2, the case cannot run here.
 * Lines of case.txt:  program FILE   entry NAME   groups N   constant ID VALUE   push FILE   buffer BINDING FILE
 * words BINDING FILE and quads BINDING FILE (buffers read as texels)   output BINDING BYTES WORD (its first contents)
 * expect FILE   tolerance FILE (for each word). */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#define MAX 32 /* bindings and constants */

static void fail(const char* what, long code)
{
    fprintf(stderr, "run_case: %s: %ld\n", what, code);
    exit(2);
}

static void check(VkResult result, const char* what)
{
    if (result != VK_SUCCESS) fail(what, result);
}

static void* read_file(const char* name, size_t* bytes)
{
    FILE* file = fopen(name, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) fail(name, 0);
    *bytes = (size_t)ftell(file);
    rewind(file);
    char* text = calloc(*bytes + 1, 1);
    if (text == NULL || fread(text, 1, *bytes, file) != *bytes) fail(name, (long)*bytes);
    fclose(file);
    return text;
}

static VkPhysicalDevice find_device(VkInstance instance, const char* text)
{
    VkPhysicalDevice devices[64];
    uint32_t count = 64;
    if (vkEnumeratePhysicalDevices(instance, &count, devices) < 0) fail("vkEnumeratePhysicalDevices", count);
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (properties.apiVersion < VK_API_VERSION_1_1 || strstr(properties.deviceName, text) == NULL) continue;
        printf("%s, driver 0x%x\n", properties.deviceName, properties.driverVersion);
        return devices[i];
    }
    fail("no device of Vulkan 1.1 has this text in its name", count);
    return NULL;
}

static uint32_t compute_family(VkPhysicalDevice physical)
{
    VkQueueFamilyProperties families[64];
    uint32_t count = 64;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return i;
    fail("no queue computes", count);
    return 0;
}

/* A buffer that the host writes and reads in place. */
static VkBuffer make_buffer(VkPhysicalDevice physical, VkDevice device, size_t bytes, void** mapped)
{
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes < 16 ? 16 : bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    VkBuffer buffer;
    check(vkCreateBuffer(device, &info, NULL, &buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    VkPhysicalDeviceMemoryProperties memories;
    vkGetPhysicalDeviceMemoryProperties(physical, &memories);
    const VkFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo allocation = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
    while (!(needs.memoryTypeBits >> allocation.memoryTypeIndex & 1) ||
           (memories.memoryTypes[allocation.memoryTypeIndex].propertyFlags & wanted) != wanted)
        if (++allocation.memoryTypeIndex == memories.memoryTypeCount) fail("no memory fits a buffer", (long)bytes);
    VkDeviceMemory memory;
    check(vkAllocateMemory(device, &allocation, NULL, &memory), "vkAllocateMemory");
    check(vkBindBufferMemory(device, buffer, memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, mapped), "vkMapMemory");
    return buffer;
}

static int compare(const uint32_t* found, const uint32_t* wanted, const uint32_t* tolerances, size_t words)
{
    size_t wrong = 0;
    for (size_t i = 0; i < words; ++i) {
        const uint32_t a = found[i], b = wanted[i];
        if ((a > b ? a - b : b - a) <= (tolerances != NULL ? tolerances[i] : 0)) continue;
        if (wrong++ == 0) printf("word %zu is %u (0x%08x) instead of %u (0x%08x)\n", i, a, a, b, b);
    }
    printf("%zu of %zu words differ\n", wrong, words);
    return wrong != 0;
}

/* What case.txt says. */
static const char* entry = "main";
static uint32_t groups = 1, push[64], constants[MAX];
static VkSpecializationMapEntry constant_entries[MAX];
static VkDescriptorSetLayoutBinding bindings[MAX];
static VkDescriptorBufferInfo buffers[MAX];
static VkBufferView views[MAX];
static uint32_t constant_count, binding_count, push_bytes;
static uint32_t *code, *output, *expected, *tolerances;
static size_t code_bytes, output_bytes;

static void read_buffer(VkPhysicalDevice physical, VkDevice device, const char* key, char* line, const char* text)
{
    char file[4096] = "";
    uint32_t word = 0, *contents = NULL;
    size_t bytes = 0;
    const uint32_t i = binding_count++;
    void* mapped;
    if (i == MAX || sscanf(text, "%u %4095s", &bindings[i].binding, file) != 2) fail(line, MAX);
    if (key[0] != 'o') contents = read_file(file, &bytes);
    if (key[0] == 'o' && sscanf(text, "%*u %zu %u", &bytes, &word) != 2) fail(line, 0);
    const VkBuffer buffer = make_buffer(physical, device, bytes, &mapped);
    if (contents != NULL) memcpy(mapped, contents, bytes);
    if (contents == NULL) {
        output = mapped;
        output_bytes = bytes;
        for (size_t at = 0; at < bytes / 4; ++at)
            output[at] = word;
    }
    const int is_texels = key[0] == 'w' || key[0] == 'q';
    bindings[i].descriptorType =
        is_texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    buffers[i] = (VkDescriptorBufferInfo){buffer, 0, VK_WHOLE_SIZE};
    VkBufferViewCreateInfo view = {VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    view.buffer = buffer;
    view.format = key[0] == 'q' ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32_UINT;
    view.range = VK_WHOLE_SIZE;
    if (is_texels) check(vkCreateBufferView(device, &view, NULL, &views[i]), "vkCreateBufferView");
}

static void read_case(VkPhysicalDevice physical, VkDevice device)
{
    size_t bytes;
    char *next = NULL, *manifest = read_file("case.txt", &bytes);
    for (char* line = strtok_r(manifest, "\n", &next); line != NULL; line = strtok_r(NULL, "\n", &next)) {
        char key[32] = "", text[4096] = "";
        if (line[0] == '#' || sscanf(line, "%31s %4095[^\n]", key, text) < 1) continue;
        if (strcmp(key, "program") == 0) {
            code = read_file(text, &code_bytes);
        } else if (strcmp(key, "entry") == 0) {
            entry = strdup(text);
        } else if (strcmp(key, "groups") == 0) {
            groups = (uint32_t)atoi(text);
        } else if (strcmp(key, "constant") == 0) {
            VkSpecializationMapEntry* one = &constant_entries[constant_count];
            if (constant_count == MAX || sscanf(text, "%u %u", &one->constantID, &constants[constant_count]) != 2)
                fail(line, MAX);
            one->offset = 4 * constant_count++;
            one->size = 4;
        } else if (strcmp(key, "push") == 0) {
            const void* file = read_file(text, &bytes);
            if (bytes > sizeof(push)) fail(line, (long)bytes);
            memcpy(push, file, push_bytes = (uint32_t)bytes);
        } else if (strcmp(key, "buffer") == 0 || strcmp(key, "output") == 0 || strcmp(key, "words") == 0 ||
                   strcmp(key, "quads") == 0) {
            read_buffer(physical, device, key, line, text);
        } else if (strcmp(key, "expect") == 0 || strcmp(key, "tolerance") == 0) {
            *(key[0] == 'e' ? &expected : &tolerances) = read_file(text, &bytes);
            if (bytes != output_bytes) fail(line, (long)bytes);
        } else
            fail(line, 0);
    }
    if (code == NULL || output == NULL || expected == NULL) fail("case.txt lacks a program, output or expect", 0);
}

static VkDescriptorSet make_set(VkDevice device, VkDescriptorSetLayout layout)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, MAX},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, MAX}};
    VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, NULL, 0, 1, 2, sizes};
    VkDescriptorPool pool;
    check(vkCreateDescriptorPool(device, &pool_info, NULL, &pool), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, NULL, pool, 1, &layout};
    VkDescriptorSet set;
    check(vkAllocateDescriptorSets(device, &info, &set), "vkAllocateDescriptorSets");
    for (uint32_t i = 0; i < binding_count; ++i) {
        VkWriteDescriptorSet write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set;
        write.dstBinding = bindings[i].binding;
        write.descriptorCount = 1;
        write.descriptorType = bindings[i].descriptorType;
        write.pBufferInfo = &buffers[i];
        write.pTexelBufferView = &views[i];
        vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    }
    return set;
}

static VkPipeline make_pipeline(VkDevice device, VkPipelineLayout layout)
{
    VkShaderModuleCreateInfo module_info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, NULL, 0, code_bytes, code};
    VkSpecializationInfo values = {constant_count, constant_entries, sizeof(constants), constants};
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = entry;
    info.stage.pSpecializationInfo = &values;
    info.layout = layout;
    check(vkCreateShaderModule(device, &module_info, NULL, &info.stage.module), "vkCreateShaderModule");
    VkPipeline pipeline;
    check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), "vkCreateComputePipelines");
    return pipeline;
}

static void run(VkDevice device, uint32_t family)
{
    VkDescriptorSetLayoutCreateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, NULL, 0,
                                                binding_count, bindings};
    VkDescriptorSetLayout set_layout;
    check(vkCreateDescriptorSetLayout(device, &set_info, NULL, &set_layout), "vkCreateDescriptorSetLayout");
    VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
    VkPipelineLayoutCreateInfo layout_info = {
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, NULL, 0, 1, &set_layout, push_bytes != 0, &range};
    VkPipelineLayout layout;
    check(vkCreatePipelineLayout(device, &layout_info, NULL, &layout), "vkCreatePipelineLayout");
    const VkPipeline pipeline = make_pipeline(device, layout);
    const VkDescriptorSet set = make_set(device, set_layout);
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, family};
    VkCommandPool pool;
    check(vkCreateCommandPool(device, &pool_info, NULL, &pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool,
                                        VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, NULL);
    if (push_bytes != 0) vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes, push);
    vkCmdDispatch(commands, groups, 1, 1);
    VkMemoryBarrier barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_SHADER_WRITE_BIT,
                               VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         NULL, 0, NULL);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkQueue queue;
    vkGetDeviceQueue(device, family, 0, &queue);
    VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
}

int main(int argc, char** argv)
{
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0, &application};
    VkInstance instance;
    check(vkCreateInstance(&instance_info, NULL, &instance), "vkCreateInstance");
    const VkPhysicalDevice physical = find_device(instance, argc > 1 ? argv[1] : "");
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, compute_family(physical), 1, &priority};
    VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, NULL, 0, 1, &queue_info};
    VkDevice device;
    check(vkCreateDevice(physical, &device_info, NULL, &device), "vkCreateDevice");
    read_case(physical, device);
    run(device, queue_info.queueFamilyIndex);
    return compare(output, expected, tolerances, output_bytes / 4);
}
