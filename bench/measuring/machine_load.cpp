#include "bench/measuring/machine_load.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
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

std::optional<double> busy_seconds(const std::set<unsigned>& processors)
{
    std::ifstream file("/proc/stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto ticks = busy_ticks(text, processors);
    return ticks ? std::optional(*ticks / static_cast<double>(::sysconf(_SC_CLK_TCK))) : std::nullopt;
}

/// Processor time of this process, in all its threads.
double own_seconds()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
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

LoadMeter::LoadMeter()
    : processors_(allowed_processors()), busy_s_(busy_seconds(processors_)), own_s_(own_seconds()),
      start_s_(now_seconds())
{
}

std::optional<MachineLoad> LoadMeter::load() const
{
    const double wall_s = now_seconds() - start_s_;
    const auto busy_s = busy_seconds(processors_);
    MachineLoad load;
    if (!busy_s_ || !busy_s || wall_s <= 0 || ::getloadavg(&load.average, 1) != 1) return std::nullopt;
    load.others = std::max(0.0, (*busy_s - *busy_s_) - (own_seconds() - own_s_)) / wall_s;
    load.processors = static_cast<unsigned>(processors_.size());
    return load;
}

} // namespace tetrace
