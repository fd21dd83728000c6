#include "tests/merging/merge_fixture.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const std::vector<const char*> counted_answers = {"name", "status", "counts", "verification", "views_hash"};
const std::string command = "reproduce table4 --method maria,ms06 --layout tet80 --size 64 --views 0-1281:20 "
                            "--backend openmp --scene cubes --resolution 6 --threads 1";

/// The program as mpirun starts it: as several ranks, in one folder.
class Ranks : public MergeTest {
protected:
    /// job: null: of a launcher that names none, as MPICH. killed_at: the line of its journal after which it is killed.
    [[nodiscard]] pid_t start(unsigned rank, unsigned size, const std::string& arguments, const char* job = "1",
                              const char* killed_at = nullptr)
    {
        std::istringstream words("tetrace " + arguments);
        std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
        std::vector<char*> pointers;
        for (std::string& word : list)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t child = ::fork();
        if (child != 0) return child;
        const std::string number = std::to_string(rank), of = std::to_string(size);
        if (job != nullptr) {
            ::setenv("OMPI_COMM_WORLD_RANK", number.c_str(), 1);
            ::setenv("OMPI_COMM_WORLD_SIZE", of.c_str(), 1);
            ::setenv("OMPI_COMM_WORLD_LOCAL_RANK", number.c_str(), 1);
            ::setenv("PMIX_NAMESPACE", job, 1);
        } else {
            ::setenv("PMI_RANK", number.c_str(), 1);
            ::setenv("PMI_SIZE", of.c_str(), 1);
            ::setenv("MPI_LOCALRANKID", number.c_str(), 1);
            ::setenv("MPI_LOCALNRANKS", of.c_str(), 1);
        }
        if (killed_at != nullptr) {
            ::setenv("LD_PRELOAD", TETRACE_KILLING_SYNC, 1);
            ::setenv("TETRACE_KILLED_AT_SYNC", killed_at, 1);
        }
        ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
        if (::chdir(folder_.path().c_str()) != 0) ::_exit(126);
        const std::string name = "rank" + std::to_string(rank);
        ::dup2(::open((name + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(::open((name + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        ::execv(TETRACE_PROGRAM, pointers.data());
        ::_exit(127);
    }

    static int end(pid_t child)
    {
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    /// The exit codes of all ranks, started together.
    std::vector<int> run_all(unsigned size, const std::string& arguments, const char* job = "1")
    {
        std::vector<pid_t> children;
        for (unsigned rank = 0; rank < size; ++rank)
            children.push_back(start(rank, size, arguments, job));
        std::vector<int> codes;
        for (const pid_t child : children)
            codes.push_back(end(child));
        return codes;
    }
};

} // namespace

TEST_F(Ranks, share_a_run_and_rank_0_merges_it)
{
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    EXPECT_EQ(run_all(4, command + " --out all.json"), std::vector<int>(4, 0)) << file("rank0.err");
    EXPECT_EQ(keys_of(section("all.json")["rows"], counted_answers),
              keys_of(section("whole.json")["rows"], counted_answers));
    EXPECT_EQ(section("all.json")["merged"]["shards"], 4);
    EXPECT_TRUE(contains(file("rank0.out"), "merged of 4 shards"));
    EXPECT_EQ(file("rank1.out"), "") << "one rank prints for all";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "all.shard-2-of-4.json.lock"));
}

TEST_F(Ranks, results_of_an_earlier_launch_are_not_taken_for_this_one_s)
{
    EXPECT_EQ(run_all(2, command + " --out all.json", "1"), (std::vector<int>{0, 0}));
    const pid_t alone = start(0, 2, command + " --wait 1s --out all.json", "2");
    EXPECT_EQ(end(alone), 3) << "rank 1 of launch 2 never came";
    EXPECT_TRUE(contains(file("rank0.err"), "1 of 2 ranks ended without a result"));
}

// MPICH's launcher names no launch. Here each launch is a process of its own, as it is there.
TEST_F(Ranks, launches_without_a_name_are_distinguished_by_the_process_that_started_their_ranks)
{
    const auto launch = [&](unsigned ranks, const std::string& more) {
        const pid_t launcher = ::fork();
        if (launcher == 0) {
            int worst = 0;
            for (const int code : run_all(ranks, command + more + " --out all.json", nullptr))
                worst = std::max(worst, code);
            ::_exit(worst);
        }
        return end(launcher);
    };
    EXPECT_EQ(launch(2, ""), 0) << file("rank0.err");
    const std::string job = section("all.shard-2-of-2.json")["shard"]["job"];
    EXPECT_TRUE(job.starts_with("launcher ")) << job;
    EXPECT_EQ(section("all.shard-1-of-2.json")["shard"]["job"], job);
    const pid_t launcher = ::fork();
    if (launcher == 0) ::_exit(end(start(0, 2, command + " --wait 1s --out all.json", nullptr)));
    EXPECT_EQ(end(launcher), 3) << "rank 1 of this launch never came";
    EXPECT_TRUE(contains(file("rank0.err"), "1 of 2 ranks ended without a result")) << file("rank0.err");
}

TEST_F(Ranks, write_google_benchmark_s_own_form_each_to_its_own_file)
{
    const std::string bench =
        "bench --backend openmp --layout tet80 --scene cubes --resolution 6 --size 16 --samples 3 --sample-time 0 "
        "--benchmark_out=gb.json --out all.json";
    EXPECT_EQ(run_all(2, bench), (std::vector<int>{0, 0})) << file("rank0.err");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "gb.json"));
    for (const char* const name : {"gb.shard-1-of-2.json", "gb.shard-2-of-2.json"})
        EXPECT_TRUE(Json::parse(file(name)).contains("benchmarks")) << name;
}

TEST_F(Ranks, a_dead_rank_is_named_and_can_be_run_again)
{
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    const pid_t first = start(0, 2, command + " --wait 2s --out all.json");
    EXPECT_EQ(end(start(1, 2, command + " --out all.json", "1", "3")), -1);
    EXPECT_EQ(end(first), 3);
    const std::string told = file("rank0.err");
    const std::string tail = " --threads 1 --shard 2/2 --out all.shard-2-of-2.json --resume";
    EXPECT_TRUE(contains(told, "--resolution 6" + tail)) << told;
    EXPECT_TRUE(contains(told, "tetrace merge all.shard-1-of-2.json all.shard-2-of-2.json --out all.json")) << told;
    ASSERT_EQ(run(command.substr(0, command.find(" --threads")) + tail).code, 0);
    ASSERT_EQ(run("merge all.shard-1-of-2.json all.shard-2-of-2.json --out all.json").code, 0);
    EXPECT_EQ(keys_of(section("all.json")["rows"], counted_answers),
              keys_of(section("whole.json")["rows"], counted_answers));
}

TEST_F(Ranks, a_launch_can_be_repeated_as_a_whole_and_goes_on)
{
    EXPECT_EQ(run_all(2, command + " --out all.json", "1"), (std::vector<int>{0, 0}));
    const std::string journal = file("all.shard-2-of-2.json.journal");
    EXPECT_EQ(run_all(2, command + " --resume --out all.json", "2"), (std::vector<int>{0, 0})) << file("rank0.err");
    EXPECT_EQ(file("all.shard-2-of-2.json.journal"), journal) << "nothing was traced again";
}

TEST_F(Ranks, need_a_file_and_share_nothing_on_request)
{
    EXPECT_EQ(end(start(0, 2, command)), 2);
    EXPECT_TRUE(contains(file("rank0.err"), "this is rank 0 of 2"));
    EXPECT_EQ(end(start(1, 2, command + " --shard 1/1 --out whole.json")), 0);
    EXPECT_FALSE(section("whole.json").contains("shard"));
}

TEST_F(Ranks, more_ranks_than_views_are_refused_by_all)
{
    const std::string check = "check --backend openmp --scene cubes --resolution 6 --size 16 --out all.json";
    EXPECT_EQ(run_all(5, check), std::vector<int>(5, 2));
    EXPECT_EQ(run_all(4, check), std::vector<int>(4, 0)) << file("rank0.err");
    EXPECT_EQ(section("all.json")["matrix"].size(), 1u);
}
