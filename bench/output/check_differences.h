#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// Full details of the row's first ray that differs from openmp's and the first that the oracle finds wrong: pixel,
/// view, hits, and the tets of the walks on both sides. Empty where there is neither, or the row has no answer.
[[nodiscard]] std::string differences_text(const RowRun& row);

/// Adds the tets of those walks to the row's JSON: "path", openmp's walk, and "own_path", the device's.
void add_paths(nlohmann::json& row_json, const RowRun& row);

} // namespace tetrace
