#pragma once

#include "bench/rows/row_record.h"
#include "bench/terminal/table.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

// The parts of `tetrace check`'s result that show rows against devices. rows: all of a run; a scene's rows are found by
// its label.

/// Each device's result for each row: one line per kernel, one column per device, cells as conformity_text() gives
/// them.
[[nodiscard]] Table matrix_table(const std::string& scene, const std::vector<RowRecord>& rows);

/// The keys of all columns of the three tables of a check of these rows.
[[nodiscard]] std::vector<std::string> check_columns_of(const std::vector<RowKey>& keys);

/// The distinct answers: the hash of each answer's hits, the devices that gave it, and the oracle's counts.
[[nodiscard]] Table answers_table(const std::string& scene, const std::vector<RowRecord>& rows);

/// Explains the columns of all matrices: each device and its self-test in exact mode, one per line. Devices of one name
/// and several drivers have their driver's library with it.
[[nodiscard]] Table self_test_table(const std::vector<RowRecord>& rows);

/// {scene: {row: {device: {"cell": ..., "hit_hash": ...}}}}.
[[nodiscard]] nlohmann::json matrix_json(const std::vector<RowRecord>& rows);

/// Full details of the row's first ray that differs from openmp's and the first that the oracle finds wrong: pixel,
/// view, hits, the tets of the walks on both sides, and the command that follows the ray. Empty if there is neither, or
/// the row is without hits.
[[nodiscard]] std::string differences_text(const RowRecord& row);

} // namespace tetrace
