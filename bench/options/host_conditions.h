#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tetrace {

/// What decides how fast a machine runs, apart from what it is. A member is empty if the system does not report it.
struct HostConditions {
    std::string governor;            ///< of CPU frequencies: "powersave"; "performance, powersave" if CPUs differ
    std::optional<bool> turbo;       ///< whether CPUs may exceed their base frequency
    std::optional<bool> smt;         ///< whether cores run several threads
    std::optional<bool> on_battery;  ///< of a machine that has a battery or reports its mains
    std::uint64_t memory_bytes = 0;  ///< of the machine; 0: not known
    std::optional<double> cpu_limit; ///< of a container: CPUs' worth of time
    std::uint64_t memory_limit = 0;  ///< of a container, in bytes; 0: none

    /// Why the machine may run more slowly than it can, or change its speed: "CPU frequency governor powersave";
    /// empty if nothing says so.
    [[nodiscard]] std::string slowing_text() const;

    friend bool operator==(const HostConditions&, const HostConditions&) = default;
};

/// Those of this machine, from /proc and /sys. root: where these two are; tests have their own.
[[nodiscard]] HostConditions host_conditions(const std::filesystem::path& root = "/");

/// As results record them, under "conditions": only what is known.
[[nodiscard]] nlohmann::json conditions_json(const HostConditions& conditions);

} // namespace tetrace
