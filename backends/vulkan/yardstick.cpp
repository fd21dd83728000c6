#include "backends/vulkan/yardstick.h"

#include "backends/vulkan/program.h"
#include "core/device/yardstick.h"

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
