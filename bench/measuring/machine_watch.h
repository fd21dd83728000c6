#pragma once

#include "bench/measuring/pulse.h"
#include "bench/measuring/sampling/sampler.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// How steady the machine was through a run of `reproduce`, over all its scenes, its searches, and the processes that a
/// resumed run took: its pulse, and the work of others, which the journal keeps; and who asks its GPUs.
class MachineWatch {
public:
    /// host: the work of its pulse. before: what new_readings() of the run's earlier processes gave, in their order.
    /// clock: the host's; tests pass their own. sampled_until_s: when the last sample of earlier processes ended.
    /// find_monitor: of a row's GPU. Throws nlohmann::json's exceptions or std::domain_error where a reading is
    /// damaged.
    explicit MachineWatch(Pulses::Work host, const std::vector<nlohmann::json>& before = {}, Clock clock = host_clock(),
                          double sampled_until_s = 0, FindMonitor find_monitor = find_gpu_monitor);

    MachineWatch(const MachineWatch&) = delete;
    MachineWatch& operator=(const MachineWatch&) = delete;

    [[nodiscard]] Pulses& pulses() { return pulses_; }
    [[nodiscard]] Monitors& monitors() { return monitors_; }
    /// Seconds since the run's first process began, without the time between its processes.
    [[nodiscard]] double now() const { return clock_(); }

    /// What was read since the last call, for the journal's entry; null if nothing was. with_load: also the load of
    /// a stretch so short that it would rather be read later.
    [[nodiscard]] nlohmann::json new_readings(bool with_load);

    /// Of all that new_readings() has told, weighted by time; empty if the system does not tell.
    [[nodiscard]] std::optional<MachineLoad> load() const;

    static constexpr const char* entry_key = "machine"; ///< of its readings in an entry of the journal

private:
    /// A load and how long it lasted.
    struct Stretch {
        MachineLoad load;
        double seconds;
    };
    void restore(const nlohmann::json& readings);

    double before_s_; ///< the time that earlier processes took, as far as they recorded it
    Clock clock_;
    Pulses pulses_;
    Monitors monitors_;
    std::map<std::string, std::size_t> written_; ///< by pulse: readings that the journal has
    std::vector<Stretch> stretches_;
    LoadMeter meter_;
    double metered_from_s_;
};

} // namespace tetrace
