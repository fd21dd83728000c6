#pragma once

#include "bench/measuring/budget.h"
#include "bench/measuring/image_record.h"
#include "bench/measuring/machine_watch.h"

#include <functional>
#include <vector>

namespace tetrace {

/// The timed rows on GPUs, then those on the host, which include emulated ones; those groups that have any. Samples are
/// interleaved only within a group, so that no GPU rests while a CPU works.
[[nodiscard]] std::vector<std::vector<RowRun*>> sample_groups(const std::vector<RowRun*>& rows);

/// Passes that make a sample at least so long; max_passes at most. pass_s: device seconds of one.
[[nodiscard]] std::uint32_t passes_for(double sample_s, double pass_s);

/// Passes with a launch for each view that a row gets in addition to its samples: 5 and no more than samples, but fewer
/// if they would take more than a tenth of the samples' time; one at least. passes: of a sample.
[[nodiscard]] unsigned latency_passes(unsigned samples, std::uint32_t passes);

/// The launches of a row, one after the other, that are timed as a whole.
struct Pass {
    RowRun* row;
    std::size_t launches;
    std::function<std::vector<TraceJob>(std::size_t launch)> prepare; ///< gives the session what the launch needs
    /// Called after each, untimed, with how many outputs its passes have written; may be empty.
    std::function<void(std::size_t launch, std::size_t outputs)> after = {};
    std::function<void(double fraction)> tell_progress = [](double) {}; ///< called before each
    std::uint32_t in_flight = 1; ///< passes of each that may be on the device together
};

/// Does a pass, each launch `passes` times. meanwhile: called during the last launch; may be empty. Throws what the
/// session throws, and what pass.after throws.
[[nodiscard]] LaunchTimes run_pass(const Pass& pass, std::uint32_t passes, const Clock& clock,
                                   const std::function<void()>& meanwhile = {});

/// Adds samples to others of the same row.
void append_samples(RowSamples& samples, const RowSamples& more);
/// Adds samples to those that the row has.
void add_samples(RowRun& row, const RowSamples& more);

/// Takes samples of rows.
class Sampler {
public:
    /// sample_s: that each sample lasts at least; 0: a pass. budget: once it is spent, no sample is taken again.
    /// watch: takes the pulse between samples, asks GPUs during each, and has the clock of the samples; null: the
    /// samples are taken by the budget's clock, and nothing else is read.
    Sampler(double sample_s, const Budget& budget, MachineWatch* watch)
        : sample_s_(sample_s), budget_(&budget), watch_(watch)
    {
    }

    /// Sets the row's passes after a pass that warmed it up: as many as launches in flight, at least.
    void warmed_up(RowRun& row, double pass_s) const;

    /// Takes a sample of row.passes passes, which grow where they were too short, and adds it to `samples`. Launching
    /// and waiting are those of a pass that is done by itself before it, since several passes share theirs. If the GPU
    /// was throttled meanwhile, the sample is taken again, twice at most. Throws as run_pass() does.
    void take(const Pass& pass, RowSamples& samples) const;

    [[nodiscard]] const Clock& clock() const { return watch_ == nullptr ? budget_->clock() : watch_->clock(); }

private:
    [[nodiscard]] LaunchTimes unthrottled(const Pass& pass, std::optional<GpuReadings>& readings) const;

    double sample_s_;
    const Budget* budget_;
    MachineWatch* watch_;
};

} // namespace tetrace
