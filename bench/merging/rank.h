#pragma once

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

} // namespace tetrace
