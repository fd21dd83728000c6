#include "bench/measuring/pulse.h"

#include "backends/openmp/yardstick.h"
#include "bench/rows/physical_device.h"
#include "bench/statistics/statistics.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr double every_s = 2; // a pulse takes some milliseconds

} // namespace

double Pulse::fastest_s() const
{
    return std::ranges::min_element(readings, {}, &Reading::seconds)->seconds;
}

double Pulse::ratio() const
{
    return std::ranges::max_element(readings, {}, &Reading::seconds)->seconds / fastest_s();
}

double Pulse::ratio_beside(double begin_s, double end_s) const
{
    const auto after = std::ranges::find_if(readings, [&](const Reading& reading) { return reading.at_s >= end_s; });
    const auto inside = std::ranges::find_if(readings, [&](const Reading& reading) { return reading.at_s > begin_s; });
    double slower = 0;
    if (after != readings.end()) slower = after->seconds;
    if (inside != readings.begin()) slower = std::max(slower, std::prev(inside)->seconds);
    return slower / fastest_s();
}

Pulses::Pulses(Work host, Clock clock) : clock_(std::move(clock))
{
    takers_.push_back({{"host", {}}, std::move(host)});
    const ControlGroups groups;
    if (groups.throttling())
        set_throttled_periods([groups] { return groups.throttling().value_or(Throttling()).periods; });
}

void Pulses::set_throttled_periods(std::function<std::uint64_t()> periods)
{
    throttled_periods_ = std::move(periods);
    throttled_ = throttled_periods_();
}

Pulses::Pulses(const std::vector<RowRun*>& rows, Work host, Clock clock) : Pulses(std::move(host), std::move(clock))
{
    watch(rows, last_view_pulse(clock_));
}

void Pulses::watch(const std::vector<RowRun*>& rows, const RowWork& gpu, const std::string& of)
{
    for (std::size_t i = 1; i < takers_.size(); ++i)
        takers_[i].ended = true;
    last_s_.reset();
    std::vector<Device> devices;
    for (const RowRun* row : rows)
        devices.push_back(row->device);
    const auto hardware = physical_devices(devices);
    std::map<std::size_t, std::size_t> known;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        RowRun& row = *rows[i];
        if (!is_timed(row)) continue;
        std::size_t taker = 0;
        if (!runs_on_host(row.device)) {
            const auto [piece, is_new] = known.emplace(hardware[i], 0);
            if (is_new) {
                piece->second = taker_of(row.device.name + of);
                Taker& taken = takers_[piece->second];
                taken.work = [gpu, &row] { return gpu(row); };
                taken.ended = false;
            }
            taker = piece->second;
        }
        rows_[&row] = {taker, {}};
    }
}

/// The taker of that name that no other piece of hardware has now: its pulse so far, or a new one.
std::size_t Pulses::taker_of(const std::string& of)
{
    const auto known =
        std::ranges::find_if(takers_, [&](const Taker& taker) { return taker.ended && taker.pulse.of == of; });
    if (known != takers_.end()) return static_cast<std::size_t>(known - takers_.begin());
    takers_.push_back({{of, {}}, {}});
    return takers_.size() - 1;
}

void Pulses::restore(const Pulse& pulse)
{
    auto known = std::ranges::find_if(takers_, [&](const Taker& taker) { return taker.pulse.of == pulse.of; });
    if (known == takers_.end()) known = takers_.insert(known, {{pulse.of, {}}, {}, true});
    auto& readings = known->pulse.readings;
    readings.insert(readings.end(), pulse.readings.begin(), pulse.readings.end());
}

void Pulses::take()
{
    for (Taker& taker : takers_) {
        if (taker.ended) continue;
        const double at_s = clock_();
        const auto seconds = taker.work();
        taker.ended = !seconds || *seconds <= 0;
        if (!taker.ended) taker.pulse.readings.push_back({at_s, *seconds});
    }
    last_s_ = clock_();
    if (throttled_periods_) throttled_ = throttled_periods_();
}

void Pulses::take_if_due()
{
    if (!last_s_ || clock_() - *last_s_ >= every_s) take();
}

void Pulses::sampled(const RowRun& row, double begin_s, double end_s)
{
    const auto watched = rows_.find(&row);
    if (watched == rows_.end()) return;
    watched->second.intervals.emplace_back(begin_s, end_s);
    if (!throttled_periods_) return;
    const std::uint64_t now = throttled_periods_();
    watched->second.throttled += now - std::min(now, throttled_);
    throttled_ = now;
}

void Pulses::judge_rows(std::vector<RowRun>& rows, const std::optional<MachineLoad>& load) const
{
    for (RowRun& row : rows) {
        const auto samples = rows_.find(&row);
        if (samples == rows_.end() || samples->second.intervals.empty()) continue;
        const Pulse& pulse = takers_.at(samples->second.taker).pulse;
        std::vector<double> ratios;
        if (!pulse.readings.empty())
            for (const auto& [begin_s, end_s] : samples->second.intervals)
                ratios.push_back(pulse.ratio_beside(begin_s, end_s));
        if (!ratios.empty()) row.pulse_ratio = quantile(ratios, 0.5);
        const bool feels_load = load && runs_on_host(row.device);
        row.disturbance = disturbance_text(row.pulse_ratio, feels_load ? &*load : nullptr);
        if (samples->second.throttled > 0 && runs_on_host(row.device))
            append_item(row.disturbance, "; ",
                        fmt::format("the container's CPU quota stopped it {} times", samples->second.throttled));
        if (row.readings && row.readings->throttled() > 0)
            append_item(row.disturbance, "; ",
                        fmt::format("its GPU was throttled in {} of {} samples ({})", row.readings->throttled(),
                                    row.readings->states.size(), row.readings->reasons));
    }
}

std::vector<Pulse> Pulses::found() const
{
    std::vector<Pulse> pulses;
    for (const Taker& taker : takers_)
        if (!taker.pulse.readings.empty()) pulses.push_back(taker.pulse);
    return pulses;
}

Pulses::Work host_pulse(unsigned threads)
{
    return [threads] { return std::optional(openmp::pulse_s(threads)); };
}

Pulses::RowWork last_view_pulse(Clock clock)
{
    return [clock = std::move(clock)](RowRun& row) {
        return median_launch_s(
            row, [&] { return prepare_view(row, last_view_with_rays(row)); }, clock);
    };
}

std::optional<double> median_launch_s(RowRun& row, const std::function<TraceJob()>& job, const Clock& clock)
{
    std::optional<double> median;
    if (!is_timed(row)) return median;
    guarded(row, [&] {
        const TraceJob prepared = job();
        std::array<double, 3> times{};
        for (double& seconds : times)
            seconds = timed_launch(*row.session, prepared, clock).kernel_s;
        std::ranges::sort(times);
        median = times[1];
    });
    return median;
}

std::string disturbance_text(std::optional<double> pulse_ratio, const MachineLoad* load)
{
    std::string text;
    if (pulse_ratio && *pulse_ratio >= noisy_pulse)
        text = fmt::format("calibration during its samples took {:.2f} times its fastest", *pulse_ratio);
    if (load != nullptr && !load->is_quiet())
        append_item(text, "; ", fmt::format("other processes used {:.2f} of {} CPUs", load->others, load->processors));
    return text;
}

} // namespace tetrace
