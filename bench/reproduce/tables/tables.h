#pragma once

#include "bench/measuring/row_devices.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/search_run.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/statistics/break_even.h"

#include <utility>
#include <vector>

namespace tetrace {

// Each table and figure is made in a file of its own name.

/// Our number and the paper's of the same thing; without a ratio where the run's scene is too unlike the paper's, and
/// without the paper's where the tets are for rays.
[[nodiscard]] PaperCell quantity_beside(const Estimate& ours, std::optional<double> paper, const SceneRun& run);

/// Why the numbers of these scenes are compared with the paper's although they are not its own, or are not compared: a
/// sentence for each run of another mesh, or of counts that are only near.
[[nodiscard]] std::vector<std::string> likeness_notes(const SceneRuns& runs);

/// The run that decides what the paper claims of a scene: of its own build where that was traced, else of ours. Null
/// where the scene was not traced as a CDT.
[[nodiscard]] const SceneRun* judged_run(const SceneRuns& runs, std::string_view scene);

/// Table 3: tets, faces and memory of each scene in each build.
[[nodiscard]] PaperTable table3(const SceneRuns& runs);

/// The speed of those builds: rates of every row.
[[nodiscard]] PaperTable table3_rates(const SceneRuns& runs);

/// "On average 9 Mrays/s on the CPU, 280 on the GPU": at least as many, for the mean over the paper's three scenes of
/// maria's fastest rows on a device of that kind. Not testable unless each of them is like the paper's.
[[nodiscard]] Claim mean_rate_claim(const SceneRuns& runs, paper::Place place);

/// Table 4: rays with a wrong result per image of 1024 x 1024, by method, scene and device, split by what went wrong.
/// It compares the paper's methods with project, which the paper does not have.
/// population: views of the camera set, of which the runs have some or all.
[[nodiscard]] PaperTable table4(const SceneRuns& runs, std::size_t population);

/// Where those rays are: their number by view, for each scene and method.
[[nodiscard]] PaperFigure table4_views(const SceneRuns& runs);

/// The rows whose numbers represent a method: for each scene and method the first that was verified, openmp's where
/// available. In exact mode every device has the same answers.
struct MethodRow {
    const SceneRun* run = nullptr;
    std::size_t row = 0; ///< index in SceneRun::rows
};
[[nodiscard]] std::vector<MethodRow> method_rows(const SceneRuns& runs);

/// Wrong and lost rays of an image.
[[nodiscard]] std::uint64_t flawed_rays(const ImageRecord& image);

/// Table 5: the exit search by itself, by method, layout and device: rates, and the number of faces that are not the
/// exact ones.
/// devices: those that the rows ran on, measured.
[[nodiscard]] PaperTable table5(const SearchRun& run, const std::vector<RowDevice>& devices);

/// Sections 3.1 and 3.4: operations and side products of a search, counted, with the paper's.
[[nodiscard]] PaperTable operations_table();

/// Bytes that a search moves in addition to its tet, which stays in the caches for all of its rays: 32 of the ray's 48,
/// because no method needs both its origin and its moment, and the face that it writes.
inline constexpr double bytes_per_search = 32 + 4;

/// A row of the CDT and one of a BVH that traced the same views on the same device; Embree's rows pair with openmp's.
struct RowPair {
    const SceneRun* run = nullptr;
    std::size_t cdt = 0, bvh = 0; ///< indices in SceneRun::rows; both have a rate
    PairedRatio ratio;            ///< the BVH's time over the CDT's
};

/// All pairs of a run, each row of the CDT with its rivals, in the order of rows.
[[nodiscard]] std::vector<RowPair> row_pairs(const SceneRun& run);

/// The pairs whose CDT row is its device's fastest, by the time of all views.
[[nodiscard]] std::vector<RowPair> fastest_pairs(const SceneRun& run);

/// Each device's fastest row of tets with the fastest BVH of that device, as `bench` finds it
/// (compare_with_best_bvh()): on a processor ours and Embree's, on a GPU those of all its APIs.
[[nodiscard]] std::vector<RowPair> best_bvh_pairs(const SceneRun& run);

/// The pair of a row of tets with that BVH; empty if there is none.
[[nodiscard]] std::optional<RowPair> best_bvh_pair(const SceneRun& run, std::size_t cdt);

/// The pair's BVH by bvh_text(): "the fastest BVH, bvh packet16 on embree".
[[nodiscard]] std::string bvh_text(const RowPair& pair);

/// The number of rays from which the CDT, or the BVH, takes less time in total, including its build; first is the CDT.
/// Empty if the interval of the ratio of their times contains 1, or a build time is unknown.
[[nodiscard]] std::optional<BreakEven> break_even(const RowPair& pair);

/// Frames of 1024 x 1024 a second, view by view.
[[nodiscard]] std::vector<double> view_frames(const SceneRun& run, std::size_t row);

/// What the paper claims of these pairs, on a GPU and on the CPU: which structure is faster on each of its scenes,
/// whose times have the larger amplitude over the views, and whose depend less on the size of the scene. And what we
/// claim: tets for rays are faster than the fastest BVH of the device, on each scene that has them.
[[nodiscard]] std::vector<Claim> pair_claims(const SceneRuns& runs);

/// Table 6: frames of 1024 x 1024 a second, build time and memory of the CDT and of each BVH.
[[nodiscard]] PaperTable table6(const SceneRuns& runs);

/// Each layout of the CDT with each BVH: the ratio of their times over the views, when the builds pay off, and the
/// claims.
[[nodiscard]] PaperTable table6_pairs(const SceneRuns& runs);

/// One figure for each scene and type of device: the ratios of fastest_pairs(), ascending, over the share of the views.
[[nodiscard]] std::vector<PaperFigure> table6_figures(const SceneRuns& runs);

/// Figure 6: time and tets traversed, one point per view. One figure for each scene and type of device
/// ("figure6-bunny-gpu"); the scene's pictures are in its first figure. A scene without a rated row has one figure
/// without points.
/// runs: timed.
[[nodiscard]] std::vector<PaperFigure> figure6(const SceneRuns& runs);

/// The same as a table: range of tets and of times, correlation and line of each row; and the claims, which cover all
/// scenes and devices.
[[nodiscard]] PaperTable figure6_table(const SceneRuns& runs);

/// The views (indices) in which a row's rays leave the fewest and the most tets.
[[nodiscard]] std::pair<std::size_t, std::size_t> extreme_views(const SceneRun& run, std::size_t row);

/// The searches and their rows as results record them (results/README.md): all data of table5.
/// Precondition: the sessions of rows without a failure are open.
[[nodiscard]] nlohmann::json searches_json(const SearchRun& run);

} // namespace tetrace
