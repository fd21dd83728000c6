#include "bench/merging/rank.h"

#include "bench/measuring/machine_load.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/printable.h"

#include <charconv>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <unistd.h>

namespace tetrace {

namespace {

using Names = std::initializer_list<const char*>;

/// The first of these variables that is set.
std::string text_in(const Environment& environment, Names names)
{
    for (const char* name : names)
        if (const char* value = environment(name)) return value;
    return {};
}

unsigned number_in(const Environment& environment, Names names)
{
    const std::string text = text_in(environment, names);
    if (text.empty()) return 0;
    unsigned number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, problem] = std::from_chars(text.data(), end, number);
    if (problem != std::errc() || rest != end || number > max_shards)
        throw Error(
            ErrorKind::usage,
            fmt::format("the environment's {} is '{}', and a rank's is a number up to {}; --shard K/N says what "
                        "this process does",
                        *names.begin(), text, max_shards));
    return number;
}

Rank read_rank(const Environment& environment, Names number, Names size, Names local)
{
    Rank rank{number_in(environment, number), number_in(environment, size), number_in(environment, local), {}};
    if (rank.number >= rank.size)
        throw Error(ErrorKind::usage, fmt::format("the environment says that this is process {} of {}, from 0 "
                                                  "({}, {}); --shard K/N says what it does",
                                                  rank.number, rank.size, *number.begin(), *size.begin()));
    return rank;
}

std::string job_of_slurm(const Environment& environment)
{
    const std::string job = text_in(environment, {"SLURM_JOB_ID"}), step = text_in(environment, {"SLURM_STEP_ID"});
    return job.empty() || step.empty() ? std::string() : fmt::format("slurm {}.{}", job, step);
}

std::string job_of_pmi(const Environment& environment, const Rank& rank, const LauncherName& launcher)
{
    if (const std::string named = text_in(environment, {"TETRACE_LAUNCH"}); !named.empty())
        return "named " + printable_text(named);
    if (const std::string job = job_of_slurm(environment); !job.empty()) return job;
    if (const std::string job = text_in(environment, {"FLUX_JOB_ID", "PALS_APID"}); !job.empty())
        return "job " + printable_text(job);
    if (number_in(environment, {"MPI_LOCALNRANKS"}) == rank.size)
        if (const std::string name = launcher(); !name.empty()) return name;
    throw Error(
        ErrorKind::usage,
        fmt::format("this is rank {} of {}, and the launcher gives the launch no name (as Slurm and Open MPI do), "
                    "so that the files of an earlier one could be taken for this one's: set TETRACE_LAUNCH to a "
                    "text that is new each time, as in 'mpiexec -genv TETRACE_LAUNCH $(date +%s) ...', or use "
                    "--shard K/N",
                    rank.number, rank.size));
}

std::string text_of_file(const std::string& path)
{
    const std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string of_process(long number, const char* what)
{
    return text_of_file(fmt::format("/proc/{}/{}", number, what));
}

bool is_rank(long number)
{
    return ('\0' + of_process(number, "environ")).find(std::string("\0PMI_RANK=", 10)) != std::string::npos;
}

} // namespace

std::string launcher_name()
{
    long number = ::getppid();
    auto process = process_times(of_process(number, "stat"));
    while (process && process->parent > 0 && is_rank(number)) {
        number = process->parent;
        process = process_times(of_process(number, "stat"));
    }
    const std::string system = text_of_file("/proc/sys/kernel/random/boot_id");
    if (!process || system.empty()) return {};
    return "launcher " + hash_text(hash_of(fmt::format("{} {} {}", system, number, process->started)));
}

std::optional<Rank> rank_of(const Environment& environment, const LauncherName& launcher)
{
    const auto has = [&](const char* name) { return environment(name) != nullptr; };
    Rank rank;
    if (has("OMPI_COMM_WORLD_RANK") && has("OMPI_COMM_WORLD_SIZE")) {
        rank =
            read_rank(environment, {"OMPI_COMM_WORLD_RANK"}, {"OMPI_COMM_WORLD_SIZE"}, {"OMPI_COMM_WORLD_LOCAL_RANK"});
        rank.job = text_in(environment, {"PMIX_NAMESPACE", "OMPI_MCA_ess_base_jobid", "OMPI_MCA_orte_ess_jobid"});
    } else if (has("PMI_RANK") && has("PMI_SIZE")) {
        rank = read_rank(environment, {"PMI_RANK"}, {"PMI_SIZE"}, {"MPI_LOCALRANKID", "SLURM_LOCALID"});
        if (rank.size > 1) rank.job = job_of_pmi(environment, rank, launcher);
    } else if (has("SLURM_PROCID") && has("SLURM_STEP_ID")) {
        rank = read_rank(environment, {"SLURM_PROCID"}, {"SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"}, {"SLURM_LOCALID"});
        rank.job = job_of_slurm(environment);
    }
    return rank.size > 1 ? std::optional(rank) : std::nullopt;
}

std::optional<Rank> this_rank()
{
    return rank_of([](const char* name) { return std::getenv(name); }, launcher_name);
}

} // namespace tetrace
