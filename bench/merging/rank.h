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

/// The value of a variable of the environment; null where it is not set.
using Environment = std::function<const char*(const char*)>;

/// What Open MPI (OMPI_COMM_WORLD_*), launchers with PMI (PMI_*) and Slurm's srun (SLURM_*) say; empty where none of
/// them started more than this one process. A batch script of Slurm is no rank: only srun's steps have a step's number.
/// Throws Error{usage} where a variable has no such number.
[[nodiscard]] std::optional<Rank> rank_of(const Environment& environment);

/// The same of this process's environment.
[[nodiscard]] std::optional<Rank> this_rank();

} // namespace tetrace
