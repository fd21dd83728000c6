#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// Full details of the row's first ray that differs from openmp's and the first that the oracle finds wrong: pixel,
/// view, hits, the tets of the walks on both sides, and the command that follows the ray. Empty where there is neither,
/// or the row has no answer.
[[nodiscard]] std::string differences_text(const RowRun& row);

/// Adds to the row's JSON, at those rays, "path", the tets of openmp's walk, "own_path", those of the device's, and
/// "command", the trace that follows the ray.
void add_paths(nlohmann::json& row_json, const RowRun& row);

} // namespace tetrace
