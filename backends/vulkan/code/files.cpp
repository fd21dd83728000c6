#include "backends/vulkan/code/files.h"

#include "backends/vulkan/kernels.h"

#include <cctype>

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
    text += variant.starts_with("rays")     ? "given rays"
            : variant.starts_with("search") ? "exit searches"
                                            : "primary rays";
    if (variant.ends_with("_parts")) text += ", with the tets in several buffers";
    if (variant.ends_with("_texels")) text += ", with the scene read as texels, as on emulated devices";
    if (variant.ends_with("_leaves_texels")) text += "; leaves rays at ties to another program";
    if (variant.ends_with("_left_texels")) text += "; traces the rays that another program has deferred";
    if (variant.ends_with("_pipeline")) text += ", made for a ray-tracing pipeline (--schedule pipeline)";
    return text + ", as the driver gets it; constants: 0, a tile's height (8); 1, whether all rays start outside; 2, "
                  "whether a select is faster than a minimum; 3, the entries of a stack in a group's memory; 4, all "
                  "entries of a "
                  "stack (0: the most)";
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
