#include "bench/results/rate_pulse.h"

#include "bench/statistics/statistics.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

bool RatePulse::is_noisy() const
{
    return ratio && *ratio >= noisy_pulse;
}

RatePulse pulse_of(const ResultHead& head, const ResultRow& row)
{
    const bool on_host = row.device_kind && *row.device_kind != DeviceKind::gpu;
    return {row.pulse_ratio, on_host ? head.host_pulse_s : std::nullopt};
}

std::string disturbance_between(const RatePulse& before, const RatePulse& after, bool same_machine,
                                const std::string& before_name, const std::string& after_name)
{
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
    for (const auto& [name, one] : {std::pair(before_name, &before), std::pair(after_name, &after)})
        if (one->is_noisy())
            add(fmt::format("in {} calibration during its samples took {:.2f} times its fastest", name, *one->ratio));
    if (!same_machine || !before.host_s || !after.host_s) return text;
    const double change = *after.host_s / *before.host_s, factor = std::max(change, 1 / change);
    if (factor >= noisy_pulse)
        add(fmt::format("the same machine's calibration took {:.2f} times as long in {} as in {}", factor,
                        change > 1 ? after_name : before_name, change > 1 ? before_name : after_name));
    return text;
}

} // namespace tetrace
