#include "bench/verbs/ranks.h"

#include "bench/measuring/machine_load.h"
#include "bench/merging/shard_results.h"
#include "bench/rows/scene_work.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/printable.h"
#include "core/base/stopwatch.h"
#include "core/isolation/own_gpu.h"
#include "scenes/cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <thread>

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

namespace fs = std::filesystem;

namespace {

fs::path lock_file(const fs::path& result)
{
    return result.string() + ".lock";
}

void pause()
{
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
}

/// Held while a shard is worked on. Rank 0 holds it for a moment where it looks whether anybody does.
FileLock lock_of(const fs::path& result, const Shard& shard)
{
    constexpr double patience_s = 3;
    for (const Stopwatch watch; watch.seconds() < patience_s; pause())
        if (auto lock = FileLock::try_take(lock_file(result))) return std::move(*lock);
    throw Error(ErrorKind::usage, fmt::format("another process does shard {} into '{}'; wait for its end, or name "
                                              "another file with --out",
                                              text_of(shard), result.string()));
}

void require_file(const Options& options, const Rank& rank)
{
    if (!options.out || options.out->extension() != ".json")
        throw Error(
            ErrorKind::usage,
            fmt::format("this is rank {} of {}, which share the run: name the result with --out FILE.json, in a "
                        "folder that all ranks see; --shard 1/1 runs all of it in each",
                        rank.number, rank.size));
    if (options.junit && *options.junit == "-")
        throw Error(ErrorKind::usage, "--junit -: several ranks cannot share standard output; name a file");
}

/// Whether the shard's result is there, and of this launch: that of an earlier one is about to be replaced.
bool is_done(const fs::path& result, const std::string& job)
{
    std::error_code not_there;
    if (!fs::exists(result, not_there)) return false;
    try {
        return job.empty() || read_shard(result).job == job;
    } catch (const Error&) {
        return false; // its journal is being begun anew
    }
}

/// Waits until every shard is done; gives back those that nobody has worked on for wait_s.
std::vector<Shard> wait_for_all(const fs::path& all, const Rank& rank, double wait_s)
{
    std::vector<Shard> waiting;
    for (unsigned number = 2; number <= rank.size; ++number)
        waiting.push_back({number, rank.size});
    for (Stopwatch quiet; !waiting.empty(); pause()) {
        std::erase_if(waiting, [&](const Shard& shard) {
            const fs::path file = shard_file(all, shard);
            return !FileLock::is_held(lock_file(file)) && is_done(file, rank.job);
        });
        progress_line().show(fmt::format("waiting for {} ranks", waiting.size()), -1);
        const auto is_alive = [&](const Shard& one) { return FileLock::is_held(lock_file(shard_file(all, one))); };
        if (std::ranges::any_of(waiting, is_alive)) quiet = Stopwatch();
        if (quiet.seconds() > wait_s) break;
    }
    progress_line().clear();
    return waiting;
}

/// What does a shard by itself as its rank did: a rank may have had fewer threads than a single process.
std::string command_for(const Shard& shard, const fs::path& all, const Options& options)
{
    constexpr std::string_view replaced[] = {"--out", "--format", "--wait", "--resume", "--threads"};
    std::vector<std::string> words = without_options(options.words, replaced);
    const std::string threads = options.thread_counts.empty()
                                    ? std::to_string(resolved_threads(options))
                                    : fmt::format("{}", fmt::join(options.thread_counts, ","));
    words.insert(words.end(),
                 {"--threads", threads, "--shard", text_of(shard), "--out", shard_file(all, shard).string()});
    if (options.verb == Verb::reproduce) words.emplace_back("--resume");
    return command_of(words);
}

[[noreturn]] void report_lost(const std::vector<Shard>& lost, const fs::path& all, const Options& options)
{
    std::string commands;
    for (const Shard& shard : lost)
        commands += "\n  " + command_for(shard, all, options);
    std::vector<std::string> files;
    for (unsigned number = 1; number <= lost.front().of; ++number)
        files.push_back(shard_file(all, {number, lost.front().of}).string());
    std::vector<std::string> merge = {"merge"};
    merge.insert(merge.end(), files.begin(), files.end());
    merge.insert(merge.end(), {"--out", all.string()});
    throw Error(ErrorKind::missing,
                fmt::format("{} of {} ranks ended without a result. Run those again, then merge:{}\n"
                            "  {}",
                            lost.size(), lost.front().of, commands, command_of(merge)));
}

int merge_all(const Rank& rank, const Options& asked)
{
    Options options;
    options.verb = Verb::merge;
    options.out = asked.out;
    options.format = asked.format;
    options.columns = asked.columns;
    options.junit = asked.junit;
    options.anonymous = asked.anonymous;
    for (unsigned number = 1; number <= rank.size; ++number)
        options.files.push_back(shard_file(*asked.out, {number, rank.size}));
    return merge_command(options);
}

} // namespace

bool is_shared(const Options& options)
{
    const bool takes_shards =
        options.verb == Verb::bench || options.verb == Verb::check || options.verb == Verb::reproduce;
    return takes_shards && !options.shard && !options.list && has_rows(options);
}

int run_rank(const Rank& rank, const Options& asked, const std::function<int(const Options&)>& run_verb)
{
    const auto& targets = asked.targets;
    if (std::ranges::find(targets, PaperTarget::rivals) != targets.end())
        throw Error(ErrorKind::usage, fmt::format("reproduce rivals: this is rank {} of {}, and ranks cannot share "
                                                  "this run; start it without srun or mpirun",
                                                  rank.number, rank.size));
    require_file(asked, rank);
    Options options = asked;
    options.shard = Shard{rank.size, rank.size};
    require_views(options); // the last rank is the first that would have none
    options.shard = rank.shard();
    options.out = shard_file(*asked.out, rank.shard());
    options.format = {};
    if (asked.junit) options.junit = shard_file(*asked.junit, rank.shard());
    options.job = rank.job;
    options.is_silent = true;
    if (options.devices.empty()) set_own_gpu(rank.local);
    {
        const FileLock lock = lock_of(*options.out, rank.shard());
        fs::remove(*options.out); // an earlier launch's
        const int code = run_verb(options);
        if (rank.number != 0) return code == 1 ? 0 : code;
    }
    const auto lost = wait_for_all(*asked.out, rank, asked.wait_s);
    if (!lost.empty()) report_lost(lost, *asked.out, asked);
    return merge_all(rank, asked);
}

} // namespace tetrace
