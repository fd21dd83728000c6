#include "core/device/host.h"

#include "core/base/control_groups.h"
#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/stopwatch.h"
#include "core/device/launch.h"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <fstream>
#include <new>
#include <thread>

namespace tetrace {

namespace {

std::string processor_name()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
            return printable_line(line.substr(line.find(": ") + 2));
    return "CPU";
}

/// 0 if the system does not say.
std::uint64_t largest_cache_bytes()
{
    long bytes = 0;
    for (const int level : {_SC_LEVEL2_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE, _SC_LEVEL4_CACHE_SIZE})
        bytes = std::max(bytes, sysconf(level));
    return static_cast<std::uint64_t>(bytes);
}

} // namespace

Device host_device()
{
    Device device;
    device.name = processor_name();
    device.kind = DeviceKind::cpu;
    device.id = device.name;
    const std::uint64_t bytes =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
    device.memory_bytes = std::min(bytes, ControlGroups().memory_bytes().value_or(bytes));
    device.threads = std::thread::hardware_concurrency();
    device.cache_bytes = largest_cache_bytes();
    return device;
}

bool host_has_fused_multiply()
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

void HostSession::start(std::span<const TraceJob> jobs)
{
    if (jobs.front().in_flight != 1)
        throw Error(ErrorKind::unsupported,
                    "several launches in flight: on the host, one begins when the one before it has ended");
    const OutputParts parts = output_parts(words_per_ray(task_));
    if (output_.capacity() < parts.words() && !fits_in_memory(parts.words() * sizeof(output_[0])))
        throw std::bad_alloc();
    output_.assign(parts.words(), POISON);
    const Stopwatch watch;
    on_team(threads_, jobs.front().passes, jobs.size(), [&](std::size_t job, SharedTiles& tiles) {
        run(jobs[job], parts.written(std::span(output_), job), tiles);
    });
    kernel_s_ = watch.seconds();
}

void HostSession::read_output(std::span<std::uint32_t> words)
{
    assert(words.size() == output_.size());
    std::ranges::copy(output_, words.begin());
}

} // namespace tetrace
