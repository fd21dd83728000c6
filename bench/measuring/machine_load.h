#pragma once

#include "core/base/control_groups.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

namespace tetrace {

/// How busy the machine was with other work while rows were timed.
struct MachineLoad {
    double others = 0;  ///< processors' worth of work of other processes, and of the host that a virtual machine is on
    double average = 0; ///< the system's load average over the last minute, our own work included
    unsigned processors = 1;    ///< that this process may use
    Throttling throttling = {}; ///< by the CPU quota of a container

    /// Whether the others took too little to move the rates: at most a tenth of a processor for each.
    [[nodiscard]] bool is_quiet() const { return others <= 0.1 * processors; }
};

/// Seconds of work of all kinds that a text such as /proc/stat shows for the given processors, in units of a tick.
/// Empty if it shows none of them.
[[nodiscard]] std::optional<double> busy_ticks(std::string_view text, const std::set<unsigned>& processors);

/// A process as a text such as /proc/1/stat shows it.
struct ProcessTimes {
    long parent = 0;           ///< its number
    double ticks = 0;          ///< of work of its own, and of those of its children that have ended
    std::uint64_t started = 0; ///< ticks after the system did
};
/// Empty if the text shows none.
[[nodiscard]] std::optional<ProcessTimes> process_times(std::string_view text);

/// Processor time of this process, in all its threads, and of its children.
[[nodiscard]] double own_seconds();

/// Measures the load from its construction on. The work of this process's children is its own: drivers run there.
class LoadMeter {
public:
    LoadMeter();
    /// Empty if the system does not tell, or no time has passed.
    [[nodiscard]] std::optional<MachineLoad> load() const;

private:
    std::set<unsigned> processors_;
    std::optional<double> busy_s_;
    Throttling throttling_;
    double own_s_ = 0, start_s_ = 0;
};

} // namespace tetrace
