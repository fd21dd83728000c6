#include "bench/rows/gpu_state.h"

#include "bench/terminal/text.h"

#include <algorithm>

namespace tetrace {

std::uint32_t GpuReadings::throttled() const
{
    return static_cast<std::uint32_t>(
        std::ranges::count_if(states, [](const GpuState& state) { return !state.throttled.empty(); }));
}

std::optional<double> GpuReadings::median(std::optional<double> GpuState::*member) const
{
    std::vector<double> values;
    for (const GpuState& state : states)
        if (state.*member) values.push_back(*(state.*member));
    if (values.empty()) return std::nullopt;
    std::ranges::sort(values);
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

GpuSummary GpuReadings::summary() const
{
    return {median(&GpuState::clock_mhz),
            median(&GpuState::memory_clock_mhz),
            median(&GpuState::power_w),
            median(&GpuState::temperature_c),
            dropped,
            throttled(),
            reasons};
}

void GpuReadings::add_reason(const std::string& reason)
{
    if (reasons.find(reason) == std::string::npos) append_item(reasons, ", ", reason);
}

void GpuReadings::add(const GpuReadings& others)
{
    states.insert(states.end(), others.states.begin(), others.states.end());
    dropped += others.dropped;
    for (std::size_t begin = 0; begin < others.reasons.size();) {
        const std::size_t end = std::min(others.reasons.find(", ", begin), others.reasons.size());
        add_reason(others.reasons.substr(begin, end - begin));
        begin = end + 2;
    }
}

} // namespace tetrace
