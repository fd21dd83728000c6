#include "backends/vulkan/code/files.h"

#include "backends/vulkan/kernels.h"

#include <cctype>

namespace tetrace {

namespace vulkan_sources {
/// The GLSL of each kernel, <method>_<layout>.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();
} // namespace vulkan_sources

namespace vulkan {

namespace {

/// How a program is made from the kernel's GLSL. variant: what follows the math mode in its name: "trace_texels".
std::string command_of(const std::string& spirv, const std::string& source, const KernelId& kernel,
                       const std::string& variant)
{
    std::string task;
    for (const char c : variant.substr(0, variant.find('_')))
        task += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string command = "glslangValidator -V --target-env vulkan1.1";
    if (kernel.layout == Layout::rt)
        command += " --target-env spirv1.4";
    else if (kernel.math == MathMode::fast)
        command += " -DMATH_FAST";
    command += " -D" + task;
    if (variant.ends_with("_parts")) command += " -DTETS_IN_PARTS";
    if (variant.ends_with("_texels")) command += " -DSCENE_IN_TEXELS";
    return command + " -o " + spirv + " " + source;
}

std::string what_of(const std::string& variant)
{
    std::string text = "SPIR-V of ";
    text += variant.starts_with("rays")     ? "given rays"
            : variant.starts_with("search") ? "exit searches"
                                            : "primary rays";
    if (variant.ends_with("_parts")) text += ", with the tets in several buffers";
    if (variant.ends_with("_texels")) text += ", with the scene read as texels, as on emulated devices";
    return text + ", as the driver gets it; constants: 0, a tile's height (8); 1, whether all rays start outside; 2, "
                  "whether a select is faster than a minimum";
}

} // namespace

std::vector<KernelFile> kernel_files(const KernelId& kernel)
{
    const std::string name = std::string(name_of(kernel.method)).append("_").append(name_of(kernel.layout));
    const EmbeddedKernel* const source = find_kernel(vulkan_sources::embedded_kernels(), name);
    if (source == nullptr) return {};
    std::vector<KernelFile> files = {{name + ".comp",
                                      "GLSL with its includes resolved; the commands below compile it",
                                      {},
                                      std::string(source->text())}};
    const std::string stem = embedded_name(kernel) + "_";
    for (const EmbeddedKernel& program : embedded_kernels()) {
        if (!program.name.starts_with(stem)) continue;
        const std::string variant(program.name.substr(stem.size())), spirv = std::string(program.name) + ".spv";
        files.push_back(
            {spirv, what_of(variant), command_of(spirv, name + ".comp", kernel, variant), std::string(program.text())});
    }
    return files;
}

} // namespace vulkan

} // namespace tetrace
