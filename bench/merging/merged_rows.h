#pragma once

#include "bench/merging/shard_results.h"
#include "bench/rows/row_record.h"
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

/// The rows of the whole run, without answers and times: what one shard knows of a row that all could run. A row that
/// one of them could not run, or that it found wrong while it was repeated, ends as it does there.
/// searches: the rows of searches in place of those of scenes.
[[nodiscard]] std::vector<RowRecord> rows_of_shards(const std::vector<ShardResult>& shards, bool searches = false);

/// The journal's entries of all shards in the order of the whole run: of each scene its views, ascending; then batches
/// of searches; then the rest, each once. Times of rows that several kinds of machines took are left out, and so are
/// the hashes that a shard chained.
[[nodiscard]] std::vector<nlohmann::json> merged_entries(const std::vector<ShardResult>& shards);

/// The rows of a run of `bench` or `check` with the answers of all shards, view after view, and the sums of their
/// samples where one kind of machine took all of them.
/// views: of the whole run. Throws Error{usage} naming a view that no journal has, or that several have.
[[nodiscard]] std::vector<RowRecord> merged_rows(const std::vector<ShardResult>& shards,
                                                 const std::vector<std::uint32_t>& views);

} // namespace tetrace
