#pragma once

#include "bench/measuring/gpu_monitor.h"
#include "bench/measuring/pulse.h"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace tetrace {

/// The monitors of the rows' GPUs, each found once.
class Monitors {
public:
    explicit Monitors(FindMonitor find) : find_(std::move(find)) {}
    /// Null if nothing reports about the row's device. The first call for a device may take a second.
    [[nodiscard]] GpuMonitor* of(const RowRun& row);
    /// Finds those of the timed rows now, not between samples.
    void find(const std::vector<RowRun*>& rows);

private:
    FindMonitor find_;
    std::map<std::pair<std::string, std::size_t>, std::unique_ptr<GpuMonitor>> found_;
};

/// How steady the machine was through a run, over all its scenes, its searches, and the processes that a resumed run
/// took: its pulse, and the work of others, which the journal keeps; and who asks its GPUs.
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
    [[nodiscard]] const Clock& clock() const { return clock_; }

    /// Leaves out the load until now, as that of work that is not timed.
    void begin_load();

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
