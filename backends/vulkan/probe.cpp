#include "backends/vulkan/probe.h"

#include "backends/vulkan/program.h"
#include "core/device/yardstick.h"

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

namespace tetrace {

namespace vulkan_defects {
/// The SPIR-V of each reduced kernel, by its name.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();
} // namespace vulkan_defects

namespace vulkan {

namespace {

void require_for_defect(const FoundDevice& device, std::string_view name)
{
    const Defect* const defect = find_defect(name);
    if (defect == nullptr) return;
    if (defect->need == DefectNeed::ballots && !device.has_ballots)
        throw Error(ErrorKind::unsupported, "its subgroups have no ballots in compute shaders");
}

} // namespace

std::vector<std::uint32_t> run_defect(const Context& context, std::string_view name, const DefectLaunch& launch)
{
    require_for_defect(context.found(), name);
    std::vector<std::uint32_t> results(output_words(name, launch));
    const auto words = defect_words(launch);
    const std::span<std::byte> result_bytes = std::as_writable_bytes(std::span(results));
    const auto word_bytes = std::as_bytes(std::span(words));
    const std::uint64_t large_bytes = launch.large_bytes();
    const bool is_large = large_bytes != 0;
    context.run("running " + std::string(name), word_bytes.size() + result_bytes.size() + large_bytes, [&] {
        const ProgramId id{.name = std::string(name),
                           .bindings = is_large ? std::vector{0u, 1u, 2u} : std::vector{0u, 1u},
                           .tile_height = launch.group_items, // the constant that is the size of groups
                           .kernels = vulkan_defects::embedded_kernels()};
        const Program program(context, id, ProgramCache({}));
        const Buffer from(context, word_bytes.size(), BufferUse::device);
        const Buffer to(context, result_bytes.size(), BufferUse::device);
        const Buffer staging =
            needs_staging(to) ? Buffer(context, result_bytes.size(), BufferUse::read_back) : Buffer();
        const Buffer large = is_large ? Buffer(context, large_bytes, BufferUse::device) : Buffer();
        upload(context, from, word_bytes);
        upload(context, to, result_bytes);
        program.bind(context, 0, from);
        program.bind(context, 1, to);
        if (is_large) program.bind(context, 2, large);
        const vk::raii::CommandBuffer commands = context.make_commands();
        commands.begin({});
        program.record(commands);
        commands.dispatch(launch.groups(), 1, 1);
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

namespace tetrace::vulkan {

namespace {

Yardstick measured_copies(const Context& context, std::uint64_t bytes)
{
    const Buffer from(context, bytes, BufferUse::device), to(context, bytes, BufferUse::device);
    const vk::raii::QueryPool times = context.make_timestamps();
    const vk::raii::CommandBuffer commands = context.make_commands();
    commands.begin({});
    commands.fillBuffer(from.handle(), 0, VK_WHOLE_SIZE, 1); // touched before they are timed
    commands.fillBuffer(to.handle(), 0, VK_WHOLE_SIZE, 2);
    record_barrier(context, commands);
    commands.end();
    context.submit(commands);
    context.finish();
    return measure_copies(bytes, [&](std::uint64_t each, unsigned count) {
        commands.begin({});
        record_begin_time(commands, times);
        for (unsigned time = 0; time < count; ++time) {
            if (time > 0) record_barrier(context, commands); // else several may run at once
            commands.copyBuffer(from.handle(), to.handle(), vk::BufferCopy{}.setSize(each));
        }
        record_end_time(commands, times);
        commands.end();
        context.submit(commands);
        context.finish();
        return context.seconds_of(times);
    });
}

double launch_s(const Context& context, const Program& nothing)
{
    const vk::raii::CommandBuffer commands = context.make_commands();
    commands.begin({});
    nothing.record(commands);
    commands.dispatch(1, 1, 1);
    commands.end();
    return median_seconds([&] {
        context.submit(commands);
        context.finish();
    });
}

} // namespace

Yardstick measure_device(const Context& context, std::uint64_t max_buffer_bytes)
{
    const Program nothing(context, {"empty"}, ProgramCache({}));
    const std::uint64_t bytes = copied_bytes(context.facts().memory_bytes, max_buffer_bytes);
    const Yardstick measured = context.run("measuring the device", 2 * bytes, [&] {
        Yardstick copies = measured_copies(context, bytes);
        copies.launch_s = launch_s(context, nothing);
        return copies;
    });
    context.check_validation("the next call");
    return measured;
}

} // namespace tetrace::vulkan
