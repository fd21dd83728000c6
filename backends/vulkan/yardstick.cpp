#include "backends/vulkan/yardstick.h"

#include "backends/vulkan/program.h"
#include "core/device/yardstick.h"

#include <algorithm>

namespace tetrace::vulkan {

namespace {

constexpr int passes = 6;

double copy_bytes_per_s(const Context& context, std::uint64_t bytes)
{
    const Buffer from(context, bytes, Place::device), to(context, bytes, Place::device);
    const vk::raii::QueryPool times = context.make_timestamps();
    const vk::raii::CommandBuffer commands = context.make_commands();
    commands.begin({});
    commands.fillBuffer(from.handle(), 0, VK_WHOLE_SIZE, 1); // touched before they are timed
    commands.fillBuffer(to.handle(), 0, VK_WHOLE_SIZE, 2);
    record_barrier(commands);
    commands.end();
    context.submit(commands);
    context.finish();
    double best_s = 1e300;
    for (int pass = 0; pass < passes; ++pass) {
        commands.begin({});
        record_begin_time(commands, times);
        commands.copyBuffer(from.handle(), to.handle(), vk::BufferCopy{}.setSize(bytes));
        record_end_time(commands, times);
        commands.end();
        context.submit(commands);
        context.finish();
        best_s = std::min(best_s, context.seconds_of(times));
    }
    return best_s > 0 ? 2.0 * static_cast<double>(bytes) / best_s : 0;
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
    const std::uint64_t bytes = copied_bytes(context.facts(), max_buffer_bytes);
    const Yardstick measured = context.run("measuring the device", 2 * bytes, [&] {
        return Yardstick{copy_bytes_per_s(context, bytes), launch_s(context, nothing)};
    });
    context.check_validation("the next call");
    return measured;
}

} // namespace tetrace::vulkan
