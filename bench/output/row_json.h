#pragma once

#include "bench/output/row_fields.h"

namespace tetrace {

/// A scene as results record it: identity, build, counts, views.
[[nodiscard]] nlohmann::json scene_json(const SceneWork& scene, const Options& options);

/// A row as results record it: the fields of row_fields() that it has a value for.
[[nodiscard]] nlohmann::json row_json(const RowFacts& facts);

/// How fast a row is compared with its reference. Precondition: facts.comparison.
[[nodiscard]] nlohmann::json ratio_json(const RowFacts& facts);

} // namespace tetrace
