#pragma once

#include "bench/merging/shard_results.h"
#include "bench/rows/row_record.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

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
