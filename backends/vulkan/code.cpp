#include "backends/vulkan/code.h"

#include "backends/vulkan/errors.h"
#include "backends/vulkan/instance.h"
#include "backends/vulkan/kernels.h"
#include "backends/vulkan/program.h"
#include "core/base/files.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"
#include "core/device/session.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <mutex>
#include <string_view>

namespace tetrace {

namespace vulkan_sources {
/// The GLSL of each kernel, <method>_<layout>.<stage>: comp, or those of a ray-tracing pipeline.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();
} // namespace vulkan_sources

namespace vulkan {

namespace {

/// The suffix of the GLSL of a program. variant: what follows the math mode in the program's name: "trace_texels".
std::string stage_of(const std::string& variant)
{
    if (variant.ends_with("_pipeline")) return ".rgen";
    if (variant == "miss") return ".rmiss";
    return variant == "hit" ? ".rchit" : ".comp";
}

/// How a program is made from the kernel's GLSL.
std::string command_of(const std::string& spirv, const std::string& source, const KernelId& kernel,
                       const std::string& variant)
{
    std::string command = "glslangValidator -V --target-env vulkan1.1";
    if (kernel.layout == Layout::rt)
        command += " --target-env spirv1.4";
    else if (kernel.math == MathMode::fast)
        command += " -DMATH_FAST";
    if (variant != "miss" && variant != "hit") {
        command += " -D";
        for (const char c : variant.substr(0, variant.find('_')))
            command += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    if (variant.ends_with("_parts")) command += " -DTETS_IN_PARTS";
    if (variant.ends_with("_texels")) command += " -DSCENE_IN_TEXELS";
    if (variant.ends_with("_leaves_texels")) command += " -DDEFERS_RAYS";
    if (variant.ends_with("_left_texels")) command += " -DTRACES_DEFERRED";
    return command + " -o " + spirv + " " + source;
}

std::string what_of(const std::string& variant)
{
    if (variant == "miss" || variant == "hit")
        return "SPIR-V of what a ray-tracing pipeline runs for a " + variant + ", as the driver gets it";
    std::string text = "SPIR-V of ";
    text += traits_of(*value_named<Task>(variant.substr(0, variant.find('_')))).what;
    if (variant.ends_with("_parts")) text += ", with the tets in several buffers";
    if (variant.ends_with("_texels")) text += ", with the scene read as texels, as on emulated devices";
    if (variant.ends_with("_leaves_texels")) text += "; leaves rays at ties to another program";
    if (variant.ends_with("_left_texels")) text += "; traces the rays that another program has deferred";
    if (variant.ends_with("_pipeline")) text += ", made for a ray-tracing pipeline (--schedule pipeline)";
    return text + "; the driver gets it with the values of its constants: 0, a tile's height (8); 1, whether all rays "
                  "start outside; 2, whether a select is faster than a minimum; 3, the entries of a stack in a group's "
                  "memory; 4, all entries of a stack (0: the most)";
}

} // namespace

std::vector<KernelFile> kernel_files(const KernelId& kernel)
{
    const std::string name = std::string(name_of(kernel.method)).append("_").append(name_of(kernel.layout));
    std::vector<KernelFile> files;
    for (const EmbeddedKernel& source : vulkan_sources::embedded_kernels())
        if (source.name.starts_with(name + "."))
            files.push_back({std::string(source.name),
                             "GLSL with its includes resolved; the commands below compile it",
                             {},
                             std::string(source.text())});
    const std::string stem = embedded_name(kernel) + "_";
    for (const EmbeddedKernel& program : embedded_kernels()) {
        if (!program.name.starts_with(stem)) continue;
        const std::string variant(program.name.substr(stem.size())), spirv = std::string(program.name) + ".spv";
        files.push_back({spirv, what_of(variant), command_of(spirv, name + stage_of(variant), kernel, variant),
                         std::string(program.text())});
    }
    return files;
}

} // namespace vulkan

} // namespace tetrace

namespace tetrace::vulkan {

namespace {

constexpr const char* needed_extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

vk::raii::Device make_device(const FoundDevice& found)
{
    if (!found.facts.reports_code)
        throw Error(ErrorKind::unsupported,
                    "the driver of '" + found.facts.name + "' does not report its code: it lacks " + needed_extension);
    const vk::raii::PhysicalDevice physical(instance().handle(), found.handle);
    const std::array priorities = {1.0f};
    const auto queue = vk::DeviceQueueCreateInfo{}
                           .setQueueFamilyIndex(found.limits.queue_family.value_or(0))
                           .setQueuePriorities(priorities);
    const std::array extensions = {needed_extension};
    const auto features =
        vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR{}.setPipelineExecutableInfo(VK_TRUE);
    return {
        physical,
        vk::DeviceCreateInfo{}.setQueueCreateInfos(queue).setPEnabledExtensionNames(extensions).setPNext(&features)};
}

/// Made at the first call and kept: radv compiles shaders of its own for every device, for a second. Never destroyed,
/// as the instance.
const vk::raii::Device& device_of(const FoundDevice& found)
{
    static std::mutex mutex;
    static auto* const made = new std::map<VkPhysicalDevice, vk::raii::Device>;
    const std::lock_guard lock(mutex);
    const auto kept = made->find(found.handle);
    return kept != made->end() ? kept->second : made->emplace(found.handle, make_device(found)).first->second;
}

/// As sessions compile it for a GPU: each array in one storage buffer.
ProgramId program_of(const FoundDevice& found, const std::optional<KernelId>& kernel, bool starts_outside)
{
    if (!kernel) return {.name = "empty"};
    ProgramId id{.name = shader_name(*kernel),
                 .bindings = {OUTPUT_BINDING},
                 .push_constant_bytes = sizeof(LaunchParams),
                 .tile_height = tile_height_of({}),
                 .starts_outside = starts_outside,
                 .stack_top = found.stack_top};
    for (const SceneArray& array : scene_arrays(kernel->layout))
        if (std::ranges::find(id.bindings, array.binding) == id.bindings.end()) id.bindings.push_back(array.binding);
    if (kernel->task != Task::trace) id.bindings.push_back(RAYS_BINDING);
    return id;
}

double value_of(const vk::PipelineExecutableStatisticKHR& statistic)
{
    using Format = vk::PipelineExecutableStatisticFormatKHR;
    switch (statistic.format) {
    case Format::eBool32: return statistic.value.b32 != VK_FALSE ? 1 : 0;
    case Format::eInt64: return static_cast<double>(statistic.value.i64);
    case Format::eUint64: return static_cast<double>(statistic.value.u64);
    case Format::eFloat64: return statistic.value.f64;
    }
    return 0;
}

/// The machine code as text, or else the driver's last form before it.
std::string code_text(const vk::raii::Device& device, const vk::PipelineExecutableInfoKHR& executable)
{
    // The bindings' own function fetches the sizes, but no text.
    const VkPipelineExecutableInfoKHR raw = executable;
    const auto fetch = device.getDispatcher()->vkGetPipelineExecutableInternalRepresentationsKHR;
    std::uint32_t count = 0;
    fetch(*device, &raw, &count, nullptr);
    std::vector<VkPipelineExecutableInternalRepresentationKHR> forms(count);
    for (auto& form : forms)
        form.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
    fetch(*device, &raw, &count, forms.data());
    std::vector<std::string> texts;
    for (auto& form : forms) {
        texts.emplace_back(form.dataSize, '\0');
        form.pData = texts.back().data();
    }
    fetch(*device, &raw, &count, forms.data());
    for (const char* const wanted : {"Assembly", "ACO IR"})
        for (std::size_t i = 0; i < forms.size(); ++i)
            if (forms[i].isText && std::string_view(forms[i].name) == wanted && texts[i].size() > 1)
                return texts[i].substr(0, texts[i].find('\0'));
    return {};
}

} // namespace

CompiledCode compiled_code(const FoundDevice& found, const std::optional<KernelId>& kernel, bool starts_outside,
                           const std::filesystem::path& program_file)
{
    ProgramId id = program_of(found, kernel, starts_outside);
    const std::string bytes = program_file.empty() ? std::string() : required_bytes(program_file);
    const EmbeddedKernel given{id.name, std::as_bytes(std::span(bytes))};
    if (!bytes.empty()) id.kernels = {&given, 1};
    try {
        const vk::raii::Device& device = device_of(found);
        const auto set_layout = make_set_layout(device, id);
        const auto layout = make_pipeline_layout(device, id, set_layout);
        using Flag = vk::PipelineCreateFlagBits;
        const auto pipeline = compile(device, id, layout, nullptr,
                                      vk::ComputePipelineCreateInfo{}.setFlags(
                                          Flag::eCaptureStatisticsKHR | Flag::eCaptureInternalRepresentationsKHR));
        const auto executables =
            device.getPipelineExecutablePropertiesKHR(vk::PipelineInfoKHR{}.setPipeline(*pipeline));
        if (executables.empty())
            throw Error(ErrorKind::unsupported,
                        "the driver of '" + found.facts.name + "' does not report the code of " + id.name);
        const auto first = vk::PipelineExecutableInfoKHR{}.setPipeline(*pipeline);
        CompiledCode code{found.facts.driver + ", " + found.facts.name, executables.front().subgroupSize, {}, {}, {}};
        for (const auto& statistic : device.getPipelineExecutableStatisticsKHR(first))
            code.statistics[statistic.name.data()] = value_of(statistic);
        code.text = code_text(device, first);
        return code;
    } catch (const vk::SystemError& failure) {
        throw to_error(failure, {"compiling " + id.name, found.facts.name, 0, found.facts.memory_bytes});
    }
}

} // namespace tetrace::vulkan
