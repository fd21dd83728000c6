#include "backends/vulkan/defects/run_defect.h"

#include "backends/vulkan/program.h"
#include "core/debugging/defects.h"

namespace tetrace {

namespace vulkan_defects {
/// The SPIR-V of each reduced kernel, by its name.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();
} // namespace vulkan_defects

namespace vulkan {

std::vector<std::uint32_t> run_defect(const Context& context, std::string_view name)
{
    std::vector<std::uint32_t> results(defect_items);
    const auto words = defect_words();
    const std::span<std::byte> result_bytes = std::as_writable_bytes(std::span(results));
    const auto word_bytes = std::as_bytes(std::span(words));
    context.run("running " + std::string(name), word_bytes.size() + result_bytes.size(), [&] {
        const ProgramId id{
            .name = std::string(name), .bindings = {0, 1}, .kernels = vulkan_defects::embedded_kernels()};
        const Program program(context, id, ProgramCache({}));
        const Buffer from(context, word_bytes.size(), BufferUse::device);
        const Buffer to(context, result_bytes.size(), BufferUse::device);
        const Buffer staging =
            needs_staging(to) ? Buffer(context, result_bytes.size(), BufferUse::read_back) : Buffer();
        upload(context, from, word_bytes);
        program.bind(context, 0, from);
        program.bind(context, 1, to);
        const vk::raii::CommandBuffer commands = context.make_commands();
        commands.begin({});
        program.record(commands);
        commands.dispatch(1, 1, 1);
        record_barrier(context, commands);
        commands.end();
        context.submit(commands);
        context.finish();
        read_back(context, to, staging, result_bytes);
    });
    context.check_validation("the next call");
    return results;
}

} // namespace vulkan

} // namespace tetrace
