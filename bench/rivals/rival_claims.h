#pragma once

#include "core/base/enum_names.h"
#include "core/device/backend.h"
#include "core/mesh/scene.h"

#include <optional>
#include <string_view>
#include <vector>

namespace tetrace {

/// The rows of a walk through tets that a claim is about; the fastest of them represents all.
enum class Walk {
    half32,  ///< project on half32, one ray at a time
    tet64,   ///< project on tet64, one ray at a time
    maria,   ///< the paper's method, one ray at a time
    packets, ///< project on half32 in packets
    single,  ///< every walk of one ray at a time
    any
};
template <>
inline constexpr auto enum_names<Walk> = names_up_to<Walk::any>("half32", "tet64", "maria", "packets",
                                                                "the fastest walk of one ray at a time",
                                                                "the fastest walk");

/// The rows that it is compared with; the fastest of them represents all.
enum class Rival {
    our_single,    ///< our BVHs, which trace one ray at a time, in every form
    embree_single, ///< Embree's single rays
    embree,        ///< Embree's, with every entry point
    single,        ///< every BVH that is traced one ray at a time
    any            ///< every BVH of the device, with every entry point
};
template <>
inline constexpr auto enum_names<Rival> = names_up_to<Rival::any>("our fastest BVH", "Embree's single rays",
                                                                  "Embree's fastest entry point",
                                                                  "the fastest BVH of one ray at a time",
                                                                  "the fastest BVH of the device");

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
