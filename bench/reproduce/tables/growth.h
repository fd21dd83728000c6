#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"

#include <vector>

namespace tetrace {

/// The build of a scene that is there in several sizes.
inline constexpr const char* growth_build = "growth";

/// The sizes that are made where none are asked for: triangles of banana.
[[nodiscard]] const std::vector<std::uint32_t>& growth_sizes();
/// The views that are traced where none are asked for: every 64th of the camera set.
inline constexpr const char* growth_views = "0-1281:64";

/// A scene in these sizes, ascending and each once: of banana their triangles, of cubes the cubes along an axis.
/// request: what is built, but for its size; its name is "banana" or "cubes".
[[nodiscard]] std::vector<SceneBuild> growth_builds(const SceneRequest& request, std::vector<std::uint32_t> sizes);

/// What tracing comes to as one scene is refined: a row a size and row of the run.
[[nodiscard]] PaperTable growth_table(const SceneRuns& runs);

/// The exponents of power laws of the number of occlusive faces that fit it: a row a kernel and device.
[[nodiscard]] PaperTable growth_exponents(const SceneRuns& runs);

/// Lines over the number of occlusive faces: a ray's time, a figure a type of device, and what a ray visits.
[[nodiscard]] std::vector<PaperFigure> growth_figures(const SceneRuns& runs);

} // namespace tetrace
