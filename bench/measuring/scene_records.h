#pragma once

#include "bench/measuring/scene_rows.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// A scene as results record it: identity, build, counts, views.
[[nodiscard]] nlohmann::json scene_json(const SceneWork& scene, const Options& options);

/// The scenes of a run as results record them, each with the size of its first packed tets.
[[nodiscard]] std::vector<nlohmann::json> scene_records(const SceneRows& run, const Options& options);

} // namespace tetrace
