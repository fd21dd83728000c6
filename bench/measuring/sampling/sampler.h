#pragma once

#include "bench/measuring/budget.h"
#include "bench/measuring/gpu/gpu_monitor.h"
#include "bench/rows/row_tracing.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// The monitors of the rows' GPUs, each found once.
class Monitors {
public:
    explicit Monitors(FindMonitor find) : find_(std::move(find)) {}
    /// Null if nothing reports about the row's device. The first call for a device may take a second.
    [[nodiscard]] GpuMonitor* of(const RowRun& row);

private:
    FindMonitor find_;
    std::map<std::pair<std::string, std::size_t>, std::unique_ptr<GpuMonitor>> found_;
};

/// The timed rows on GPUs, then those on the host, which include emulated ones; those groups that have any. Samples are
/// interleaved only within a group, so that no GPU rests while a CPU works.
[[nodiscard]] std::vector<std::vector<RowRun*>> sample_groups(std::vector<RowRun>& rows);

/// Passes that make a sample at least so long; max_passes at most. pass_s: device seconds of one.
[[nodiscard]] std::uint32_t passes_for(double sample_s, double pass_s);

/// Passes with a launch for each view that a row gets in addition to its samples: 5 and no more than samples, but fewer
/// if they would take more than a tenth of the samples' time; one at least. passes: of a sample.
[[nodiscard]] unsigned latency_passes(unsigned samples, std::uint32_t passes);

/// A sample that was kept; begin_s and end_s are those of all its passes and repeats, by the budget's clock.
struct Sample {
    LaunchTimes pass; ///< of one pass
    double begin_s, end_s;
};

/// Takes samples of any work that can be done several times in a row.
class Sampler {
public:
    /// Does the work this many times between two readings of the device's clock; returns the seconds of all of them.
    /// meanwhile: to be called while the device does the last part of it; may be empty.
    using Work = std::function<LaunchTimes(std::uint32_t passes, const std::function<void()>& meanwhile)>;

    /// sample_s: that each sample lasts at least; 0: a pass. budget: whose clock is read; once it is spent, no sample
    /// is taken again. monitors: asked during each sample; null: no GPU is.
    Sampler(double sample_s, const Budget& budget, Monitors* monitors)
        : sample_s_(sample_s), budget_(&budget), monitors_(monitors)
    {
    }

    /// Sets the row's passes after a pass that warmed it up.
    void warmed_up(RowRun& row, double pass_s) const;

    /// Takes a sample of row.passes passes, which grow where they were too short. Launching and waiting are those of a
    /// pass that is done by itself before it, since several passes share theirs. If the GPU was throttled meanwhile,
    /// the sample is taken again, twice at most. row.readings has what its GPU told. Throws what the work throws.
    [[nodiscard]] Sample take(RowRun& row, const Work& work) const;

private:
    [[nodiscard]] LaunchTimes unthrottled(RowRun& row, const Work& work) const;

    double sample_s_;
    const Budget* budget_;
    Monitors* monitors_;
};

} // namespace tetrace
