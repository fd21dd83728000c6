#pragma once

#include "bench/merging/rank.h"
#include "bench/options/options.h"

#include <functional>

namespace tetrace {

/// Whether the options ask for a run that ranks share among them: of a verb that takes --shard, without that option.
[[nodiscard]] bool is_shared(const Options& options);

/// Runs a verb as a rank: its shard, its own GPU, its own result and journal, ALL.shard-K-of-N.json for the ALL.json of
/// --out. Rank 0 then waits for the others, merges, prints, and has the exit code of the whole run; the others' is 0
/// once their results are written, since launchers end all ranks for another.
/// Throws Error{usage} for `reproduce rivals`, without a file for the result, or where another process does the same
/// shard; Error{missing} from rank 0 naming the ranks that gave no sign of life, and how to go on.
[[nodiscard]] int run_rank(const Rank& rank, const Options& options,
                           const std::function<int(const Options&)>& run_verb);

} // namespace tetrace
