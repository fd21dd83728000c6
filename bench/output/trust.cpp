#include "bench/output/trust.h"

#include "bench/measuring/figures.h"
#include "bench/results/row_keys.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

std::string load_text(const std::optional<MachineLoad>& load)
{
    if (!load) return "the load while measuring is not known";
    std::string text = fmt::format("other processes used {:.2f} of {} CPUs while measuring, load average {:.1f}",
                                   load->others, load->processors, load->average);
    if (load->throttling.periods > 0)
        text += fmt::format("; the container's CPU quota stopped this run {} times, for {:.1f} s",
                            load->throttling.periods, load->throttling.seconds);
    return text;
}

std::string pulses_text(const std::vector<Pulse>& pulses)
{
    std::string text;
    for (const Pulse& pulse : pulses)
        text += fmt::format("; calibration of {}: {} runs, slowest {:.2f}x the fastest",
                            pulse.of == "host" ? "the host" : pulse.of, pulse.readings.size(), pulse.ratio());
    return text;
}

std::optional<MachineLoad> load_from(const ResultValue& section)
{
    const auto load = section.find("load");
    if (!load) return std::nullopt;
    MachineLoad read{load->at("others").number(), load->at("average").number()};
    read_into(read.processors, load->at("processors"));
    read_member(read.throttling.periods, *load, "throttled_periods");
    read_member(read.throttling.seconds, *load, "throttled_s");
    return read;
}

std::vector<Pulse> pulses_from(const ResultValue& section)
{
    std::vector<Pulse> pulses;
    const auto list = section.find("pulses");
    if (!list) return pulses;
    for (const ResultValue& value : list->items()) {
        Pulse& pulse = pulses.emplace_back(Pulse{value.at("of").line(), {}});
        for (const ResultValue& reading : value.at("readings").items()) {
            const auto pair = reading.items();
            if (pair.size() != 2 || pair[1].number() <= 0) reading.reject("is not a reading: write [when, seconds]");
            pulse.readings.push_back({pair[0].number(), pair[1].number()});
        }
        if (pulse.readings.empty()) value.reject("is a calibration without readings");
    }
    return pulses;
}

/// Those that slowing_text() names.
HostConditions conditions_from(const ResultValue& section)
{
    HostConditions conditions;
    if (const auto recorded = section.find("conditions")) {
        read_member(conditions.governor, *recorded, "governor");
        read_member(conditions.on_battery, *recorded, "on_battery");
    }
    return conditions;
}

void count_rows(Steadiness& steadiness, const ResultValue& part)
{
    const auto rows = part.find("rows");
    if (!rows) return;
    for (const ResultValue& row : rows->items()) {
        if (!row.find(row_key::median_s)) continue;
        ++steadiness.timed;
        const auto noisy = row.find(row_key::noisy);
        steadiness.noisy += noisy && noisy->flag() ? 1 : 0;
        steadiness.disturbed += row.find(row_key::disturbed) ? 1 : 0;
    }
}

constexpr const char* again = "measure again on a quieter machine (docs/calm-machine.md).";

} // namespace

void Steadiness::count(const RowRecord& row)
{
    const auto figures = figures_of(row);
    if (!figures) return;
    ++timed;
    noisy += figures->noisy ? 1 : 0;
    disturbed += row.disturbance.empty() ? 0 : 1;
}

std::string trust_text(const Steadiness& all)
{
    const std::string slowing = all.conditions.slowing_text();
    const std::string what = fmt::format("{}{}{}{}; {} of {} rows noisy", load_text(all.load), pulses_text(all.pulses),
                                         slowing.empty() ? "" : "; ", slowing, all.noisy, all.timed);
    if (all.disturbed == all.timed || (all.load && !all.load->is_quiet()))
        return fmt::format("{}: do not trust these rates; {}", what, again);
    if (all.disturbed > 0) return fmt::format("{}: do not trust the noisy ones; {}", what, again);
    return what + (2 * all.noisy > all.timed ? ": trust only differences that the intervals confirm." : ".");
}

Steadiness read_steadiness(const ResultValue& section)
{
    Steadiness steadiness{load_from(section), pulses_from(section), conditions_from(section)};
    count_rows(steadiness, section);
    if (const auto searches = section.find("searches")) count_rows(steadiness, *searches);
    return steadiness;
}

} // namespace tetrace
