#include "backends/vulkan/yardstick.h"

#include "backends/vulkan/program.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace tetrace::vulkan {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{128} << 20;
constexpr int passes = 6;
constexpr int launches = 51;

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
    std::vector<double> seconds;
    for (int i = 0; i < launches; ++i) {
        const auto start = std::chrono::steady_clock::now();
        context.submit(commands);
        context.finish();
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(seconds.begin(), seconds.begin() + launches / 2, seconds.end());
    return seconds[launches / 2];
}

} // namespace

Yardstick measure_device(const Context& context, std::uint64_t max_buffer_bytes)
{
    const Program nothing(context, {"empty"}, ProgramCache({}));
    const std::uint64_t bytes = std::min({most_bytes, max_buffer_bytes, context.facts().memory_bytes / 4}) & ~3ull;
    const Yardstick measured = context.run("measuring the device", 2 * bytes, [&] {
        return Yardstick{copy_bytes_per_s(context, bytes), launch_s(context, nothing)};
    });
    context.check_validation("the next call");
    return measured;
}

} // namespace tetrace::vulkan
