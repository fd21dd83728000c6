#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"

#include <vector>

namespace tetrace {

/// The build of a scene that is available in several sizes.
inline constexpr const char* growth_build = "growth";

/// The default sizes: triangles of banana.
[[nodiscard]] const std::vector<std::uint32_t>& growth_sizes();
/// The default views: every 64th of the camera set.
inline constexpr const char* growth_views = "0-1281:64";

/// A scene in these sizes, ascending and each once. A size is the number of triangles for banana, and of cubes along an
/// axis for cubes.
/// request: what is built, except for its size; its name is "banana" or "cubes".
[[nodiscard]] std::vector<SceneBuild> growth_builds(const SceneRequest& request, std::vector<std::uint32_t> sizes);

/// The cost of tracing as one scene is refined: one row for each size and row of the run.
[[nodiscard]] PaperTable growth_table(const SceneRuns& runs);

/// The exponents of fitted power laws in the number of occlusive faces: one row for each kernel and device.
[[nodiscard]] PaperTable growth_exponents(const SceneRuns& runs);

/// Lines over the number of occlusive faces: a ray's time, one figure for each type of device, and what a ray visits.
[[nodiscard]] std::vector<PaperFigure> growth_figures(const SceneRuns& runs);

} // namespace tetrace
