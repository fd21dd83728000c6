#include "backends/vulkan/probe.h"

#include "backends/vulkan/program.h"

namespace tetrace::vulkan {

namespace {

constexpr std::uint32_t group_items = 64; // local_size_x of probe.comp

} // namespace

std::vector<std::uint32_t> run_probe(const Context& context, MathMode math, std::span<const Quad> operations)
{
    std::vector<std::uint32_t> results(operations.size());
    if (operations.empty()) return results;
    const std::span<std::byte> result_bytes = std::as_writable_bytes(std::span(results));
    context.run("running the self-test", operations.size_bytes() + result_bytes.size(), [&] {
        const ProgramId id{.name = std::string("probe_").append(name_of(math)), .bindings = {0, 1}};
        const Program program(context, id, ProgramCache({}));
        const Buffer quads(context, operations.size_bytes(), BufferUse::device);
        const Buffer words(context, result_bytes.size(), BufferUse::device);
        const Buffer staging =
            needs_staging(words) ? Buffer(context, result_bytes.size(), BufferUse::read_back) : Buffer();
        upload(context, quads, std::as_bytes(operations));
        program.bind(context, 0, quads);
        program.bind(context, 1, words);
        const vk::raii::CommandBuffer commands = context.make_commands();
        commands.begin({});
        program.record(commands);
        commands.dispatch((static_cast<std::uint32_t>(operations.size()) + group_items - 1) / group_items, 1, 1);
        record_barrier(context, commands);
        commands.end();
        context.submit(commands);
        context.finish();
        read_back(context, words, staging, result_bytes);
    });
    context.check_validation("the next call");
    return results;
}

} // namespace tetrace::vulkan
