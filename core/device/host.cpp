#include "core/device/host.h"

#include "core/base/printable.h"

#include <unistd.h>

#include <fstream>
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

} // namespace

Device host_device()
{
    Device device;
    device.name = processor_name();
    device.kind = DeviceKind::cpu;
    device.id = device.name;
    device.memory_bytes =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
    device.threads = std::thread::hardware_concurrency();
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

} // namespace tetrace
