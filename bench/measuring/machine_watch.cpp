#include "bench/measuring/machine_watch.h"

#include "bench/rows/json_numbers.h"

#include <algorithm>
#include <stdexcept>

namespace tetrace {

namespace {

/// The system counts work in hundredths of a second: a load of less than this cannot be distinguished from none.
constexpr double shortest_stretch_s = 2;

double positive_from(const nlohmann::json& number)
{
    const double value = amount_from(number);
    if (value <= 0) throw std::domain_error("calibration must take more than 0 s");
    return value;
}

double end_of(const Pulse& pulse)
{
    return pulse.readings.empty() ? 0 : pulse.readings.back().at_s + pulse.readings.back().seconds;
}

} // namespace

GpuMonitor* Monitors::of(const RowRun& row)
{
    const auto [place, is_new] = found_.try_emplace({row.key.backend, row.key.device});
    if (is_new) place->second = find_(row.device);
    return place->second.get();
}

void Monitors::find(const std::vector<RowRun*>& rows)
{
    for (const RowRun* row : rows)
        if (is_timed(*row)) (void)of(*row);
}

MachineWatch::MachineWatch(Pulses::Work host, const std::vector<nlohmann::json>& before, Clock clock,
                           double sampled_until_s, FindMonitor find_monitor)
    : before_s_(sampled_until_s), clock_([this, clock = std::move(clock)] { return before_s_ + clock(); }),
      pulses_(std::move(host), [this] { return now(); }), monitors_(std::move(find_monitor))
{
    for (const nlohmann::json& readings : before)
        restore(readings);
    for (const Pulse& pulse : pulses_.found())
        before_s_ = std::max(before_s_, end_of(pulse));
    metered_from_s_ = now();
}

void MachineWatch::restore(const nlohmann::json& readings)
{
    if (readings.contains("pulses"))
        for (const nlohmann::json& one : readings["pulses"]) {
            Pulse pulse{one.at("of"), {}};
            for (const nlohmann::json& reading : one.at("readings"))
                pulse.readings.push_back({amount_from(reading.at(0)), positive_from(reading.at(1))});
            written_[pulse.of] += pulse.readings.size();
            pulses_.restore(pulse);
        }
    if (!readings.contains("load")) return;
    const nlohmann::json& load = readings["load"];
    MachineLoad read{amount_from(load.at("others")), amount_from(load.at("average")),
                     count_from<unsigned>(load.at("processors"))};
    if (load.contains("throttled_periods"))
        read.throttling = {count_from<std::uint64_t>(load["throttled_periods"]), amount_from(load.at("throttled_s"))};
    stretches_.push_back({read, positive_from(load.at("seconds"))});
}

nlohmann::json MachineWatch::new_readings(bool with_load)
{
    nlohmann::json found;
    for (const Pulse& pulse : pulses_.found()) {
        std::size_t& written = written_[pulse.of];
        nlohmann::json readings = nlohmann::json::array();
        for (; written < pulse.readings.size(); ++written)
            readings.push_back({pulse.readings[written].at_s, pulse.readings[written].seconds});
        if (!readings.empty()) found["pulses"].push_back({{"of", pulse.of}, {"readings", std::move(readings)}});
    }
    const auto load = meter_.load();
    const double seconds = now() - metered_from_s_;
    if (!load || seconds <= 0 || (!with_load && seconds < shortest_stretch_s)) return found;
    found["load"] = {
        {"others", load->others}, {"average", load->average}, {"processors", load->processors}, {"seconds", seconds}};
    if (load->throttling.periods > 0) {
        found["load"]["throttled_periods"] = load->throttling.periods;
        found["load"]["throttled_s"] = load->throttling.seconds;
    }
    stretches_.push_back({*load, seconds});
    begin_load();
    return found;
}

void MachineWatch::begin_load()
{
    meter_ = LoadMeter();
    metered_from_s_ = now();
}

std::optional<MachineLoad> MachineWatch::load() const
{
    if (stretches_.empty()) return std::nullopt;
    MachineLoad mean = stretches_.back().load;
    mean.throttling = {};
    double work = 0, seconds = 0;
    for (const Stretch& stretch : stretches_) {
        work += stretch.load.others * stretch.seconds;
        seconds += stretch.seconds;
        mean.throttling.periods += stretch.load.throttling.periods;
        mean.throttling.seconds += stretch.load.throttling.seconds;
    }
    mean.others = work / seconds;
    return mean;
}

} // namespace tetrace
