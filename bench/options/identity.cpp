#include "bench/options/identity.h"

#include "bench/options/commit.h"
#include "core/base/printable.h"

#include <charconv>
#include <ctime>
#include <fmt/chrono.h>
#include <fstream>
#include <sched.h>
#include <sys/utsname.h>

namespace tetrace {

namespace {

/// The value on the first line that starts with `key`, without the key and surrounding quotes.
std::string value_in(const char* file, const std::string& key, char separator)
{
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind(key, 0) != 0) continue;
        std::string value = line.substr(line.find(separator) + 1);
        value.erase(0, value.find_first_not_of(" \t\""));
        value.erase(value.find_last_not_of(" \t\"") + 1);
        return printable_line(value);
    }
    return "unknown";
}

/// A number of /proc/cpuinfo; empty if there is none, as on ARM. The key ends in a tab there.
std::optional<unsigned> processor_number(const std::string& key)
{
    const std::string text = value_in("/proc/cpuinfo", key + "\t", ':');
    unsigned number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    return problem == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

} // namespace

BuildIdentity build_identity()
{
#if defined(__clang__)
    const char* const compiler = __VERSION__;
#else
    const char* const compiler = "GCC " __VERSION__;
#endif
    return {TETRACE_VERSION, TETRACE_COMMIT, compiler,
            TETRACE_FLAGS "; kernels exact: " TETRACE_FLAGS_EXACT "; kernels fast: " TETRACE_FLAGS_FAST,
            TETRACE_LIBRARIES};
}

HostIdentity host_identity()
{
    utsname system{};
    uname(&system);
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    const bool known = sched_getaffinity(0, sizeof(allowed), &allowed) == 0;
    return {value_in("/proc/cpuinfo", "model name", ':'),
            processor_number("cpu family"),
            processor_number("model"),
            processor_number("stepping"),
            printable_line(fmt::format("{}, {} {}", value_in("/etc/os-release", "PRETTY_NAME=", '='), system.sysname,
                                       system.release)),
            known ? static_cast<unsigned>(CPU_COUNT(&allowed)) : 1u};
}

std::string utc_now()
{
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

} // namespace tetrace
