#include "backends/vulkan/launch_case.h"

#include "backends/vulkan/kernels.h"
#include "backends/vulkan/session.h"
#include "backends/vulkan/specialized.h"
#include "core/base/files.h"

#include <array>
#include <cstring>
#include <fmt/ranges.h>

namespace tetrace {

namespace vulkan_defects {
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels(); // as in probe.cpp; and "run_case", the host
} // namespace vulkan_defects

namespace vulkan {

namespace {

std::string code_of(std::span<const EmbeddedKernel> kernels, std::string_view name)
{
    const EmbeddedKernel* const kernel = find_kernel(kernels, name);
    if (kernel == nullptr) throw Error(ErrorKind::internal, "vulkan lacks program " + std::string(name));
    return std::string(kernel->text());
}

LaunchCase case_of(std::span<const EmbeddedKernel> kernels, const std::string& name, std::uint32_t groups = 1)
{
    LaunchCase made;
    made.program = {name + ".spv", "the program, SPIR-V", {}, code_of(kernels, name)};
    made.host = {"run_case.c", "a host in C, whose head says how to build and run it",
                 "cc -O1 -o run_case run_case.c -l:libvulkan.so.1 && ./run_case",
                 code_of(vulkan_defects::embedded_kernels(), "run_case")};
    made.lines = {"GROUPS " + std::to_string(groups)};
    return made;
}

LaunchCase::Input case_input(const std::string& place, const std::string& name, const std::string& what,
                             std::span<const std::byte> bytes)
{
    return {place, {name + ".bin", what, {}, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())}};
}

/// The place of an array that is read as texels, or from a storage buffer.
std::string array_place(bool in_texels, const TexelBinding& texels)
{
    const char* const kind = texels.format == vk::Format::eR32Uint ? "words, " : "quads, ";
    return in_texels ? kind + std::to_string(texels.binding)
                     : "buffer, " + std::to_string(texels.binding % FIRST_QUADS_BINDING);
}

} // namespace

LaunchCase tile_case(const Device& device, const KernelId& kernel, const PackedScene& scene, const LaunchParams& launch,
                     std::span<const Quad> rays, const std::filesystem::path& program_file)
{
    const bool in_texels = device.kind != DeviceKind::gpu && program_file.empty(); // as SessionOptions::program_file
    LaunchCase made = case_of(embedded_kernels(), shader_name(kernel) + (in_texels ? "_texels" : ""));
    const bool starts_outside = kernel.task == Task::trace && launch.start_tet == NO_TET;
    const std::array<std::uint32_t, 5> constants = {launch.tile_height, starts_outside ? 1u : 0u, in_texels ? 1u : 0u,
                                                    in_texels ? 0u : STACK_TOP_OF_GPUS, 0u};
    std::array<std::uint32_t, sizeof(LaunchParams) / sizeof(std::uint32_t)> pushed{};
    std::memcpy(pushed.data(), &launch, sizeof(launch));
    if (!program_file.empty()) made.program.bytes = required_bytes(program_file);
    const auto words = specialized(std::as_bytes(std::span(made.program.bytes)), constants);
    made.program.bytes.assign(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0]));
    made.program.what += " with its constants' values, as the driver gets it";
    made.lines.push_back(fmt::format("CONSTANTS {}", fmt::join(constants, ", ")));
    made.lines.push_back(fmt::format("PUSHED {:#x}", fmt::join(pushed, ", ")));
    const auto buffers = scene_buffers(scene);
    std::uint32_t bound = 0; // bits: an array that is read as words and as quads is one storage buffer
    for (const TexelBinding& texels : texel_bindings(kernel.layout)) {
        const std::uint32_t array = texels.binding % FIRST_QUADS_BINDING;
        if (!in_texels && (bound >> array & 1u) != 0) continue;
        bound |= 1u << array;
        made.inputs.push_back(case_input(array_place(in_texels, texels), buffers[array].name,
                                         "an array of the packed scene", buffers[array].bytes));
    }
    if (kernel.task != Task::trace)
        made.inputs.push_back(case_input(array_place(in_texels, rays_as_texels), "rays", "given rays, two quads each",
                                         std::as_bytes(rays)));
    made.output = OUTPUT_BINDING;
    return made;
}

LaunchCase defect_case(std::string_view name, const DefectLaunch& launch)
{
    LaunchCase made = case_of(vulkan_defects::embedded_kernels(), std::string(name), launch.groups());
    made.lines.push_back("CONSTANTS " + std::to_string(launch.group_items));
    made.lines.push_back("PUSHED 0");
    const auto words = defect_words(launch);
    made.inputs = {case_input("buffer, 0", "words", "what the kernel reads", std::as_bytes(std::span(words)))};
    if (launch.large_words != 0) made.lines.push_back("LARGE_BYTES " + std::to_string(launch.large_bytes()) + "u");
    made.output = 1;
    return made;
}

} // namespace vulkan

} // namespace tetrace
