#include "bench/measuring/machine_load.h"

#include "core/base/files.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sched.h>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace tetrace {

namespace {

std::set<unsigned> allowed_processors()
{
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    std::set<unsigned> numbers;
    if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return numbers;
    for (unsigned number = 0; number < CPU_SETSIZE; ++number)
        if (CPU_ISSET(number, &allowed)) numbers.insert(number);
    return numbers;
}

std::string text_of(const std::filesystem::path& path)
{
    return file_bytes(path).value_or("");
}

std::optional<double> busy_seconds(const std::set<unsigned>& processors)
{
    const auto ticks = busy_ticks(text_of("/proc/stat"), processors);
    return ticks ? std::optional(*ticks / static_cast<double>(::sysconf(_SC_CLK_TCK))) : std::nullopt;
}

/// Of children that still run; those that have ended are in the process's own usage.
double running_children_seconds()
{
    double ticks = 0;
    std::error_code none;
    for (std::filesystem::directory_iterator at("/proc", none), end; !none && at != end; at.increment(none)) {
        const auto& entry = *at;
        if (entry.path().filename().string().find_first_not_of("0123456789") != std::string::npos) continue;
        const auto process = process_times(text_of(entry.path() / "stat"));
        if (process && process->parent == ::getpid()) ticks += process->ticks;
    }
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

double now_seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

std::optional<double> busy_ticks(std::string_view text, const std::set<unsigned>& processors)
{
    std::istringstream lines{std::string(text)};
    std::optional<double> sum;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("cpu") || line.size() < 4 || line[3] == ' ') continue; // the first line has them all
        std::istringstream words(line.substr(3));
        unsigned number = 0;
        double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, interrupts = 0, soft_interrupts = 0, stolen = 0;
        words >> number >> user >> nice >> system >> idle >> waiting >> interrupts >> soft_interrupts >> stolen;
        if (words && processors.contains(number))
            sum = sum.value_or(0) + user + nice + system + interrupts + soft_interrupts + stolen;
    }
    return sum;
}

double own_seconds()
{
    double sum = running_children_seconds();
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return sum;
}

std::optional<ProcessTimes> process_times(std::string_view text)
{
    const std::size_t name_end = text.rfind(')'); // a name may hold anything
    if (name_end == std::string_view::npos) return std::nullopt;
    std::istringstream words{std::string(text.substr(name_end + 1))};
    ProcessTimes process;
    std::string skipped;
    words >> skipped >> process.parent; // the state comes first
    for (int i = 0; i < 9; ++i)
        words >> skipped;
    for (int i = 0; i < 4; ++i) {
        double ticks = 0;
        words >> ticks;
        process.ticks += ticks;
    }
    for (int i = 0; i < 4; ++i)
        words >> skipped;
    words >> process.started;
    return words ? std::optional(process) : std::nullopt;
}

LoadMeter::LoadMeter()
    : processors_(allowed_processors()), busy_s_(busy_seconds(processors_)),
      throttling_(ControlGroups().throttling().value_or(Throttling())), own_s_(own_seconds()), start_s_(now_seconds())
{
}

std::optional<MachineLoad> LoadMeter::load() const
{
    const double wall_s = now_seconds() - start_s_;
    const auto busy_s = busy_seconds(processors_);
    MachineLoad load;
    if (!busy_s_ || !busy_s || wall_s <= 0 || ::getloadavg(&load.average, 1) != 1) return std::nullopt;
    load.others = std::max(0.0, (*busy_s - *busy_s_) - (own_seconds() - own_s_)) / wall_s;
    const Throttling now = ControlGroups().throttling().value_or(throttling_);
    load.throttling = {now.periods - throttling_.periods, now.seconds - throttling_.seconds};
    load.processors = static_cast<unsigned>(processors_.size());
    return load;
}

} // namespace tetrace
