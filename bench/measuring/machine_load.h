#pragma once

#include <optional>
#include <set>
#include <string_view>

namespace tetrace {

/// How busy the machine was with other work while rows were timed.
struct MachineLoad {
    double others = 0;  ///< processors' worth of work of other processes, and of the host that a virtual machine is on
    double average = 0; ///< the system's load average over the last minute, our own work included
    unsigned processors = 1; ///< that this process may use

    /// Whether the others took too little to move the rates: at most a tenth of a processor for each.
    [[nodiscard]] bool is_quiet() const { return others <= 0.1 * processors; }
};

/// Seconds of work of all kinds that a text such as /proc/stat shows for the given processors, in units of a tick.
/// Empty where it shows none of them.
[[nodiscard]] std::optional<double> busy_ticks(std::string_view text, const std::set<unsigned>& processors);

/// Measures the load from its construction on.
class LoadMeter {
public:
    LoadMeter();
    /// Empty where the system does not tell, or no time has passed.
    [[nodiscard]] std::optional<MachineLoad> load() const;

private:
    std::set<unsigned> processors_;
    std::optional<double> busy_s_;
    double own_s_ = 0, start_s_ = 0;
};

} // namespace tetrace
