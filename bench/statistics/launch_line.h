#pragma once

#include <optional>
#include <vector>

namespace tetrace {

/// Seconds that some number of launches took for all the work, sample by sample.
struct LaunchSamples {
    double launches = 0;
    std::vector<double> seconds;
};

/// What the same work costs in any number of launches: seconds = fixed_s * launches + s_per_unit * units.
struct LaunchLine {
    std::optional<double> fixed_s; ///< of a launch; empty if the samples do not show that it is above 0
    double s_per_unit = 0;         ///< of the work; without fixed_s the joined launches' cost is in it
};

/// The line through the medians of the same work in few launches and in many. fixed_s is left out if both have as many
/// launches, and if the 95 % interval of single over joined seconds (rank_interval.h) is not above 1, or does not
/// exist. units: of the work, above 0. Throws Error{internal} for no samples.
[[nodiscard]] LaunchLine launch_line(const LaunchSamples& joined, const LaunchSamples& single, double units);

} // namespace tetrace
