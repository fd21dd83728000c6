#pragma once

#include "bench/measuring/scene_rows.h"
#include "bench/output/row_fields.h"

namespace tetrace {

/// A scene as results record it: identity, build, counts, views.
[[nodiscard]] nlohmann::json scene_json(const SceneWork& scene, const Options& options);

/// The scenes of a run as results record them, each with the size of its first packed tets.
[[nodiscard]] std::vector<nlohmann::json> scene_records(const SceneRows& run, const Options& options);

/// A row as results record it: those fields of row_fields() for which it has a value.
[[nodiscard]] nlohmann::json row_json(const RowFacts& facts);

/// A row's speed compared with its reference's. Precondition: facts.comparison.
[[nodiscard]] nlohmann::json ratio_json(const RowFacts& facts);

/// Writes into a row's record what is known only when all rows have been timed: its times' "noisy", "pulse" and
/// "disturbed".
void set_disturbance(nlohmann::json& record, const RowRun& row);

} // namespace tetrace
