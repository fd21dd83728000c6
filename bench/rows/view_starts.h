#pragma once

#include "core/mesh/moving_start.h"

#include <optional>
#include <vector>

namespace tetrace {

/// How the starts of a moving camera were found, compared with exact location.
struct StartWalk {
    MoveCounts counts;
    double exact_s = 0; ///< seconds for locating the same positions exactly, each on its own
};

/// Where the rays of each view start.
struct ViewStarts {
    std::vector<Start> starts;
    double seconds = 0;            ///< for finding them
    std::optional<StartWalk> walk; ///< of the wide domain, where cameras are inside and move from view to view
};

/// Finds the starts of views, in their order. In the wide domain each is found from the one before, and compared with
/// exact location. Throws Error{internal} if the two differ.
[[nodiscard]] ViewStarts find_starts(const Scene& scene, const std::vector<Float3>& origins);

} // namespace tetrace
