#include "bench/measuring/pulse.h"

#include "bench/rows/physical_device.h"
#include "bench/statistics/statistics.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr double every_s = 2; // a pulse takes some milliseconds

/// Seconds of the row's last view on the device's clock, the median of three times; its hits stay those that a sample
/// leaves behind.
std::optional<double> last_view_s(RowRun& row, const Clock& clock)
{
    std::optional<double> median;
    if (!is_timed(row)) return median;
    guarded(row, [&] {
        const TraceJob job = prepare_view(row, last_view_with_rays(row));
        std::array<double, 3> times{};
        for (double& seconds : times)
            seconds = timed_launch(*row.session, job, clock).kernel_s;
        std::ranges::sort(times);
        median = times[1];
    });
    return median;
}

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

Pulses::Pulses(std::vector<RowRun>& rows, Work host, Clock clock) : clock_(std::move(clock))
{
    takers_.push_back({{"host", {}}, std::move(host)});
    std::vector<Device> devices;
    for (const RowRun& row : rows)
        devices.push_back(row.device);
    const auto hardware = physical_devices(devices);
    std::map<std::size_t, std::size_t> known;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        RowRun& row = rows[i];
        if (!is_timed(row)) continue;
        std::size_t taker = 0;
        if (!runs_on_host(row.device)) {
            const auto [piece, is_new] = known.emplace(hardware[i], takers_.size());
            if (is_new) takers_.push_back({{row.device.name, {}}, [this, &row] { return last_view_s(row, clock_); }});
            taker = piece->second;
        }
        rows_[&row] = {taker, {}};
    }
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
}

void Pulses::take_if_due()
{
    if (clock_() - last_s_ >= every_s) take();
}

void Pulses::sampled(const RowRun& row, double begin_s, double end_s)
{
    rows_.at(&row).intervals.emplace_back(begin_s, end_s);
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
    }
}

std::vector<Pulse> Pulses::found() const
{
    std::vector<Pulse> pulses;
    for (const Taker& taker : takers_)
        if (!taker.pulse.readings.empty()) pulses.push_back(taker.pulse);
    return pulses;
}

std::string disturbance_text(std::optional<double> pulse_ratio, const MachineLoad* load)
{
    std::string text;
    if (pulse_ratio && *pulse_ratio >= noisy_pulse)
        text = fmt::format("the pulse beside its samples took {:.2f} times its fastest", *pulse_ratio);
    if (load != nullptr && !load->is_quiet())
        text += fmt::format("{}others used {:.2f} of {} processors", text.empty() ? "" : "; ", load->others,
                            load->processors);
    return text;
}

} // namespace tetrace
