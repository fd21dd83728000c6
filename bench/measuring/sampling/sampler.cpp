#include "bench/measuring/sampling/sampler.h"

#include "bench/rows/physical_device.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

GpuMonitor* Monitors::of(const RowRun& row)
{
    const auto [place, is_new] = found_.try_emplace({row.key.backend, row.key.device});
    if (is_new) place->second = find_(row.device);
    return place->second.get();
}

std::vector<std::vector<RowRun*>> sample_groups(std::vector<RowRun>& rows)
{
    std::vector<std::vector<RowRun*>> groups(2);
    for (RowRun& row : rows)
        if (is_timed(row)) groups[runs_on_host(row.device) ? 1 : 0].push_back(&row);
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

void Sampler::warmed_up(RowRun& row, double pass_s) const
{
    constexpr double for_faster_clocks = 1.25; // a device that has rested is slower than it will be
    row.passes = passes_for(for_faster_clocks * sample_s_, pass_s);
}

Sample Sampler::take(RowRun& row, const Work& work) const
{
    const LaunchTimes alone = row.passes > 1 ? work(1, {}) : LaunchTimes{};
    const double begin_s = budget_->now();
    const LaunchTimes all = unthrottled(row, work);
    const double end_s = budget_->now();
    const double kernel_s = all.kernel_s / row.passes;
    const LaunchTimes& launched = row.passes > 1 ? alone : all;
    row.passes = std::max(row.passes, passes_for(sample_s_, kernel_s));
    return {{kernel_s, kernel_s + launched.wall_s - launched.kernel_s}, begin_s, end_s};
}

LaunchTimes Sampler::unthrottled(RowRun& row, const Work& work) const
{
    GpuMonitor* const monitor = monitors_ == nullptr ? nullptr : monitors_->of(row);
    if (monitor == nullptr) return work(row.passes, {});
    if (!row.readings) row.readings.emplace();
    for (int attempt = 1;; ++attempt) {
        GpuState state;
        const LaunchTimes sample = work(row.passes, [&] { state = monitor->read(); });
        if (!state.throttled.empty()) row.readings->add_reason(state.throttled);
        if (state.throttled.empty() || attempt == 3 || budget_->left_s() <= 0) {
            row.readings->states.push_back(std::move(state));
            return sample;
        }
        ++row.readings->dropped;
    }
}

} // namespace tetrace
