#pragma once

#include "bench/report/campaign/campaign.h"
#include "bench/terminal/table.h"

#include <string>
#include <vector>

namespace tetrace {

/// How near an application comes to the best one on a platform. A problem is a scene with its rays, a platform a
/// machine that is not emulated, an application an API with a layout, by its fastest row.
struct Efficiency {
    std::string problem, platform, application;
    double mrays_per_s = 0;
    double efficiency = 0; ///< the rate over the best application's for this problem on this platform; at most 1
    bool noisy = false;    ///< whether one of the two rates is not to be relied on
};

/// Of the newest rates, only of rows whose every ray is right; problem by problem, then platform by platform.
/// Source: Pennycook, Sewall, Lee, "A Metric for Performance Portability" (2016), application efficiency.
[[nodiscard]] std::vector<Efficiency> efficiencies_of(const Campaign& campaign);

/// The metric of the same paper: the harmonic mean of the efficiencies on each platform; 0 if the application did not
/// run on all of them. platforms: their number, at least 1.
[[nodiscard]] double performance_portability(const std::vector<double>& efficiencies, std::size_t platforms);

/// For tools, as CSV: problem, platform, application, efficiency, noisy, mrays_per_s.
[[nodiscard]] Table portability_table(const std::vector<Efficiency>& efficiencies);

} // namespace tetrace
