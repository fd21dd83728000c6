#include "bench/measuring/sampler.h"

#include "bench/rows/physical_device.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

std::vector<std::vector<RowRun*>> sample_groups(const std::vector<RowRun*>& rows)
{
    std::vector<std::vector<RowRun*>> groups(2);
    for (RowRun* const row : rows)
        if (is_timed(*row)) groups[runs_on_host(row->device) ? 1 : 0].push_back(row);
    std::erase_if(groups, [](const auto& group) { return group.empty(); });
    return groups;
}

std::uint32_t passes_for(double sample_s, double pass_s)
{
    constexpr double most = max_passes;
    return pass_s > 0 ? static_cast<std::uint32_t>(std::clamp(std::ceil(sample_s / pass_s), 1.0, most)) : 1;
}

unsigned latency_passes(unsigned samples, std::uint32_t passes)
{
    constexpr std::uint64_t most = 5, share = 10;
    const std::uint64_t affordable = std::uint64_t{samples} * passes / share;
    return static_cast<unsigned>(std::clamp<std::uint64_t>(affordable, 1, std::min<std::uint64_t>(most, samples)));
}

LaunchTimes run_pass(const Pass& pass, std::uint32_t passes, const Clock& clock, const std::function<void()>& meanwhile)
{
    LaunchTimes sum{0, 0};
    for (std::size_t launch = 0; launch < pass.launches; ++launch) {
        // Not inside a timed interval: a sample may take minutes, and drawing adds nothing to a row's time.
        pass.tell_progress(static_cast<double>(launch) / static_cast<double>(pass.launches));
        std::vector<TraceJob> jobs = pass.prepare(launch);
        for (TraceJob& job : jobs) {
            job.passes = passes;
            job.in_flight = pass.in_flight;
        }
        const bool is_last = launch + 1 == pass.launches;
        const auto [kernel_s, wall_s] =
            timed_launch(*pass.row->session, jobs, clock, is_last ? meanwhile : std::function<void()>());
        sum.kernel_s += kernel_s;
        sum.wall_s += wall_s;
        if (pass.after) pass.after(launch, std::min(passes, pass.in_flight));
    }
    return sum;
}

namespace {

/// samples: those that have the row's names; gpu: where they keep what its GPU told.
template <class Samples>
void append(Samples& samples, std::optional<GpuReadings>& gpu, const RowSamples& more)
{
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(samples.samples_s, more.samples_s);
    add(samples.wall_samples_s, more.wall_samples_s);
    add(samples.latency_samples_s, more.latency_samples_s);
    samples.passes = std::max(samples.passes, more.passes);
    if (!more.gpu) return;
    if (!gpu) gpu.emplace();
    gpu->add(*more.gpu);
}

} // namespace

void append_samples(RowSamples& samples, const RowSamples& more)
{
    append(samples, samples.gpu, more);
    samples.sampled_s.insert(samples.sampled_s.end(), more.sampled_s.begin(), more.sampled_s.end());
}

void add_samples(RowRun& row, const RowSamples& more)
{
    append(row, row.readings, more);
}

void Sampler::warmed_up(RowRun& row, double pass_s) const
{
    constexpr double for_faster_clocks = 1.25; // a device that has rested is slower than it will be
    row.passes = std::max<std::uint32_t>(passes_for(for_faster_clocks * sample_s_, pass_s), row.key.in_flight);
}

void Sampler::take(const Pass& pass, RowSamples& samples) const
{
    RowRun& row = *pass.row;
    if (watch_ != nullptr) watch_->pulses().take_if_due();
    const LaunchTimes alone = row.passes > 1 ? run_pass(pass, 1, clock()) : LaunchTimes{};
    const double begin_s = clock()();
    const LaunchTimes all = unthrottled(pass, samples.gpu);
    const double end_s = clock()();
    const double kernel_s = all.kernel_s / row.passes;
    const LaunchTimes& launched = row.passes > 1 ? alone : all;
    row.passes = std::max(row.passes, passes_for(sample_s_, kernel_s));
    samples.samples_s.push_back(kernel_s);
    samples.wall_samples_s.push_back(kernel_s + launched.wall_s - launched.kernel_s);
    samples.passes = row.passes;
    if (watch_ == nullptr) return;
    samples.sampled_s.emplace_back(begin_s, end_s);
    watch_->pulses().sampled(row, begin_s, end_s);
}

LaunchTimes Sampler::unthrottled(const Pass& pass, std::optional<GpuReadings>& readings) const
{
    RowRun& row = *pass.row;
    GpuMonitor* const monitor = watch_ == nullptr ? nullptr : watch_->monitors().of(row);
    if (monitor == nullptr) return run_pass(pass, row.passes, clock());
    if (!readings) readings.emplace();
    for (int attempt = 1;; ++attempt) {
        GpuState state;
        const LaunchTimes sample = run_pass(pass, row.passes, clock(), [&] { state = monitor->read(); });
        if (!state.throttled.empty()) readings->add_reason(state.throttled);
        if (state.throttled.empty() || attempt == 3 || budget_->left_s() <= 0) {
            readings->states.push_back(std::move(state));
            return sample;
        }
        ++readings->dropped;
    }
}

} // namespace tetrace
