#pragma once

#include "core/pack/kernel_id.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tetrace::paper {

// All numbers that the paper prints: Maria, Horna, Aveneau, "Efficient Ray Traversal of Constrained Delaunay
// Tetrahedralization", GRAPP 2017, hal-01486575. Set-up (section 4.1): an Intel Core i7-4930K (6 cores, 3.4 GHz) with
// OpenMP, an NVIDIA GeForce GTX 680 with persistent threads, images of 1024 x 1024.

inline constexpr std::string_view citation = "Maria, Horna, Aveneau, GRAPP 2017";
inline constexpr std::string_view cpu_name = "Core i7-4930K, 6 cores", gpu_name = "GeForce GTX 680";
inline constexpr std::uint32_t image_pixels = 1024u * 1024u;

/// The two devices that it measures.
enum class Place { cpu, gpu };

/// Table 3: a scene, its tetrahedralization, and the rates of the paper's method. It counts a face once.
struct SceneFigures {
    std::string_view scene; ///< as the catalogue calls it
    std::uint64_t tets, occlusive_faces, free_faces;
    double memory_mib; ///< printed as MB: 96 bytes per tet are these numbers in units of 2^20 bytes
    double cpu_mrays, gpu_mrays;

    [[nodiscard]] double mrays(Place place) const { return place == Place::cpu ? cpu_mrays : gpu_mrays; }
};
[[nodiscard]] std::span<const SceneFigures> scenes();
/// The scene's; empty if it is not one of the paper's: banana, bunny or armadillo.
[[nodiscard]] std::optional<SceneFigures> figures_of(std::string_view scene);
[[nodiscard]] bool has_scene(std::string_view scene);
/// The text's "on average 9 Mrays/s on the CPU, 280 on the GPU": the means over the three scenes.
[[nodiscard]] double mean_mrays(Place place);

/// A mesh and TetGen's switches that come near to the paper's counts of a scene, in a domain that holds the cameras and
/// whose sides are not divided. The paper gives neither; they were found by trial (results/README.md).
struct NearestBuild {
    std::string_view scene, switches;
    std::uint64_t triangles; ///< of the mesh that gives the counts: Stanford's, or of banana the occlusive faces
};
/// Empty for other scenes than the paper's.
[[nodiscard]] std::optional<NearestBuild> nearest_build(std::string_view scene);

/// Figure 6, on the CPU, bunny from 1,282 views: the view with the fewest tets and the one with the most.
struct ExtremeView {
    double ms, mtets; ///< of an image
    [[nodiscard]] double tets_a_ray() const { return 1e6 * mtets / image_pixels; }
    [[nodiscard]] double msteps_per_s() const { return 1e3 * mtets / ms; }
};
inline constexpr std::string_view figure6_scene = "bunny";
inline constexpr ExtremeView view_a = {40.1, 9.6}, view_b = {122, 22.71};

/// Table 4: rays with a wrong result per image, on the GPU, averaged over about 1,300 views. Empty if it has none.
[[nodiscard]] std::optional<double> wrong_rays_of(std::string_view scene, Method method);

/// Table 5: milliseconds of the exit search by itself, 10,000 random tets, 16,384 random rays that stab each; on one
/// thread of the CPU, and on the GPU. Empty for methods that it does not have.
[[nodiscard]] std::optional<double> search_ms(Method method, Place place);
inline constexpr double searches = 10'000.0 * 16'384;
/// What its text says of the fastest older method: how much slower it is than the paper's own. (The table's numbers for
/// the GPU, 21 and 13 ms, are 62 %.)
struct FastestOlder {
    Method method;
    double slower; ///< a share
};
[[nodiscard]] FastestOlder fastest_older(Place place);

/// Table 6, on the GPU: frames a second over the views, minimum and maximum. Its BVH is that of Aila, Laine and Karras.
struct FrameRates {
    std::string_view scene;
    double min_cdt = 0, max_cdt = 0;
    double min_bvh = 0, max_bvh = 0;
};
/// Empty for other scenes than the paper's.
[[nodiscard]] std::optional<FrameRates> frames_of(std::string_view scene);

/// Which is faster on average, the CDT or the BVH; one row for each of its scenes.
struct PairOutcome {
    std::string_view scene;
    bool cdt_is_faster = false;
};
[[nodiscard]] std::span<const PairOutcome> outcomes();

/// Sections 3.1 and 3.4: what a search costs. 46 operations are two side products without what they share.
inline constexpr double ms06_products = 2.67, maria_products = 2, maria_operations = 28, naive_operations = 46,
                        start_products = 3;
/// Section 3.4: bytes of a tet on the CPU and on the GPU.
inline constexpr double cpu_tet_bytes = 80, gpu_tet_bytes = 96;

} // namespace tetrace::paper
