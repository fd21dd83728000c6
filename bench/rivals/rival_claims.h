#pragma once

#include "bench/rows/contest.h"
#include "core/device/backend.h"
#include "core/mesh/scene.h"

#include <optional>
#include <string_view>
#include <vector>

namespace tetrace {

/// A measurement that old figures are from.
struct OldRun {
    std::string_view name, what;
};

/// What of the two rows is compared.
enum class Measure {
    rate,      ///< rates: the walk's over the rival's
    break_even ///< seconds of tracing with the walk after which building its tets has paid; infinite: never
};

/// What this repository says, or has said, about the speed of tets and BVHs, and the rule that decides it now: the
/// measure is above the boundary (or below it) in every scene, with every kind of rays, and on every device of the
/// claim.
struct RivalClaim {
    std::string_view id, text;
    std::string_view made_in; ///< files of this repository
    std::string_view then;    ///< the old figure
    const OldRun* old;        ///< where that is from
    Walk walk;
    Rival rival;
    DeviceKind place;
    std::string_view backend;             ///< of emulated devices; empty: any
    std::vector<std::string_view> scenes; ///< empty: all
    std::vector<RayKind> rays;
    double boundary;
    std::optional<TetsKind> tets = TetsKind::rays; ///< of the scenes; empty: any
    Measure measure = Measure::rate;
    bool is_below = false;
};

/// Every claim, in the order of the page.
[[nodiscard]] const std::vector<RivalClaim>& rival_claims();

/// A scene of the default run, and the rays that it is traced with.
struct RivalScene {
    std::string_view name;
    bool has_all_rays = false;  ///< else primary, diffuse and random
    bool has_own_views = false; ///< CatalogueEntry::views
};
/// Those that the claims are about, then those on which tets do badly.
[[nodiscard]] const std::vector<RivalScene>& rival_scenes();

/// Whether a scene of that label is the scene of that name: in any size (atrium@5000), or from a bundle, which calls a
/// scene with tets for rays <name>-rays.
[[nodiscard]] bool is_scene(std::string_view label, std::string_view name);

} // namespace tetrace
