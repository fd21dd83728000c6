#pragma once

#include "bench/merging/shard_results.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// Whether a row's times may be put together: all shards that have it ran it with as many threads on one kind of
/// processor, device and driver, under one label. row: its name.
[[nodiscard]] bool is_of_one_kind(const std::vector<ShardResult>& shards, const std::string& row);

/// The machines of a merged result, as results record them: each kind with its shards, host, label, devices, and the
/// rates of its own rows over its own views and batches.
[[nodiscard]] nlohmann::json machines_json(const std::vector<ShardResult>& shards);

/// The same for people, without the rows.
[[nodiscard]] Sheet machines_sheet(const nlohmann::json& merged);

/// Writes `merged` into the section of a merged result, and makes its head that of the shards: where they were
/// measured, not where they were merged.
void set_origin(nlohmann::json& section, const std::vector<ShardResult>& shards);

} // namespace tetrace
