#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

// The parts of `tetrace check`'s result that stand rows against devices. rows: all of a run; those of one scene are
// picked by its label.

/// What each device's rows came to: a line a kernel, a column a device, cells as conformity_text() says.
[[nodiscard]] std::string matrix_text(const std::string& scene, const std::vector<RowRun>& rows);

/// The different answers, each once: the hash of its hits, the devices that gave it, and the oracle's counts.
[[nodiscard]] std::string answers_text(const std::string& scene, const std::vector<RowRun>& rows);

/// The columns of all matrices: what each device is, and its self-test in exact mode; a line each.
[[nodiscard]] std::string devices_text(const std::vector<RowRun>& rows);

/// {scene: {row: {device: {"cell": ..., "hit_hash": ...}}}}.
[[nodiscard]] nlohmann::json matrix_json(const std::vector<RowRun>& rows);

} // namespace tetrace
