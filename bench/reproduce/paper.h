#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tetrace::paper {

// The paper's numbers that results are compared with: Maria, Horna, Aveneau, "Efficient Ray Traversal of Constrained
// Delaunay Tetrahedralization", GRAPP 2017. The paper's tables hold more; what is not here is not compared.

inline constexpr std::string_view citation = "Maria, Horna, Aveneau, GRAPP 2017";
inline constexpr std::string_view rest_is_there =
    "Only those of the paper's numbers stand here that this program has; for the others consult the paper's own table.";

/// Table 3: a scene and its tetrahedralization.
struct SceneCounts {
    std::string_view scene; ///< as the catalogue calls it
    std::uint64_t triangles = 0;
    std::uint64_t tets = 0;
    std::uint64_t occlusive_faces = 0;
};
/// The paper's counts of a scene; empty where they are not known here.
[[nodiscard]] std::optional<SceneCounts> counts_of(std::string_view scene);

/// TetGen's switches for the paper's build of one of its scenes, in a domain that holds the cameras and whose sides are
/// not divided. They were found by trial: these come nearest to the paper's counts of bunny (see results/README.md).
/// armadillo, whose counts are not known here, gets the same. Empty for other scenes.
struct NearestBuild {
    std::string_view scene, switches;
};
[[nodiscard]] std::optional<std::string_view> nearest_switches(std::string_view scene);

/// Whether the scene is one of the paper's: banana, bunny or armadillo.
[[nodiscard]] bool has_scene(std::string_view scene);

/// Table 4: rays with a wrong result per image of 1024 x 1024, averaged over 1,282 images.
inline constexpr double least_wrong_of_older = 0.004, most_wrong_of_older = 457, wrong_of_maria = 0;
inline constexpr std::uint32_t image_pixels = 1024u * 1024u;

/// Table 6, on the paper's GPU: frames of 1024 x 1024 a second over the views, minimum and maximum.
struct FrameRates {
    std::string_view scene;
    double least_cdt = 0, most_cdt = 0;
    double least_bvh = 0, most_bvh = 0;
};
/// Empty where they are not known here.
[[nodiscard]] std::optional<FrameRates> frames_of(std::string_view scene);

/// Which is faster in the paper, the CDT or the BVH; one row for each of its scenes.
struct PairOutcome {
    std::string_view scene;
    bool cdt_is_faster = false;
};
[[nodiscard]] std::span<const PairOutcome> outcomes();

/// Figure 6: mean number of tets that a ray traverses, over all views: minimum and maximum.
inline constexpr double least_tets_a_ray = 9.2, most_tets_a_ray = 21.7;

/// The evaluation on the CPU: millions of tets traversed a second.
inline constexpr double least_cpu_msteps = 25, most_cpu_msteps = 40;

} // namespace tetrace::paper
