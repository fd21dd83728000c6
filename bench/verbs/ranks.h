#pragma once

#include "bench/options/options.h"
#include "bench/options/shard.h"

#include <functional>
#include <optional>
#include <string>

namespace tetrace {

/// A process among those that a launcher (srun, mpirun) has started together, as its environment says.
struct Rank {
    unsigned number = 0, size = 1; ///< number: from 0
    unsigned local = 0;            ///< number among those on this machine
    std::string job;               ///< the same for all of them, and another for the next launch; empty: not known

    [[nodiscard]] Shard shard() const { return {number + 1, size}; }
};

/// The value of a variable of the environment; null if it is not set.
using Environment = std::function<const char*(const char*)>;

/// A name of the process that started this one and the other ranks of its machine; empty if it is not known.
using LauncherName = std::function<std::string()>;

/// What Open MPI (OMPI_COMM_WORLD_*), launchers with PMI (PMI_*) and Slurm's srun (SLURM_*) say; empty if none of
/// them started more than this one process. A batch script of Slurm is not a rank: only srun's steps have a step's
/// number. A launcher with PMI outside Slurm names no launch: TETRACE_LAUNCH does, or `launcher` where all ranks are on
/// this machine (MPI_LOCALNRANKS). Throws Error{usage} if a variable lacks such a number, or nothing names the launch:
/// then the results of an earlier one could be taken for those of this one.
[[nodiscard]] std::optional<Rank> rank_of(const Environment& environment, const LauncherName& launcher);

/// The nearest ancestor of this process whose environment has no PMI_RANK, by its number, when it started, and the
/// system's start: a wrapper between the launcher and a rank makes no difference.
[[nodiscard]] std::string launcher_name();

/// The rank of this process.
[[nodiscard]] std::optional<Rank> this_rank();

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
