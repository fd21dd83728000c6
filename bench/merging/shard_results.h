#pragma once

#include "bench/measuring/run_journal.h"
#include "bench/options/shard.h"
#include "bench/results/result_file.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// A shard of a run, as its result and its journal have it.
struct ShardResult {
    ResultFile result;
    JournalFile journal;
    Shard shard;
    std::vector<std::string> arguments; ///< the command line that all shards share
    std::string job;                    ///< as Rank::job; empty if the shard was not a rank

    /// "shard 2/4 ('b.json')".
    [[nodiscard]] std::string name() const;
    /// What tetrace recorded.
    [[nodiscard]] const nlohmann::json& section() const { return result.json.at("tetrace"); }
};

/// The file of a shard of the result `out`, under a launcher: "all.shard-2-of-4.json" of "all.json".
[[nodiscard]] std::filesystem::path shard_file(const std::filesystem::path& out, const Shard& shard);

/// Reads a shard's result and journal. Throws what read_result() and read_journal() throw, and Error{usage} where the
/// result is of no shard, or the journal is not that shard's, or did not end.
[[nodiscard]] ShardResult read_shard(const std::filesystem::path& result);

/// The shards of one run, in the order of their numbers.
/// Throws Error{usage} naming the shards and both values if one is missing or doubled, or if they differ in their
/// number, verb, version, commit, compiler, flags, options, scenes or rows, or are not of this program's commit.
[[nodiscard]] std::vector<ShardResult> read_shards(const std::vector<std::filesystem::path>& results);

} // namespace tetrace
