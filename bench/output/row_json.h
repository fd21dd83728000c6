#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// A scene as results record it: identity, build, counts, views.
[[nodiscard]] nlohmann::json scene_json(const SceneWork& scene, const Options& options);

/// A row as results record it: key, device, status, verification, counts, and, where it was timed, times and rates.
[[nodiscard]] nlohmann::json row_json(const RowRun& row);

/// A ray's answer.
[[nodiscard]] nlohmann::json hit_json(const Hit& hit);

} // namespace tetrace
