#include "bench/verbs/ranks.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <map>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Variables = std::map<std::string, std::string>;

std::optional<Rank> rank_in(const Variables& variables)
{
    return rank_of(
        [&](const char* name) -> const char* {
            const auto found = variables.find(name);
            return found == variables.end() ? nullptr : found->second.c_str();
        },
        [] { return std::string("the launcher"); });
}

const Variables srun = {{"SLURM_JOB_ID", "12"},        {"SLURM_STEP_ID", "3"}, {"SLURM_PROCID", "5"},
                        {"SLURM_STEP_NUM_TASKS", "8"}, {"SLURM_NTASKS", "16"}, {"SLURM_LOCALID", "1"}};

} // namespace

TEST(Rank, srun_names_rank_size_and_local_number)
{
    const auto rank = rank_in(srun);
    ASSERT_TRUE(rank);
    EXPECT_EQ(rank->number, 5u);
    EXPECT_EQ(rank->size, 8u) << "of the step, not of the job that it is a part of";
    EXPECT_EQ(rank->local, 1u);
    EXPECT_EQ(rank->job, "slurm 12.3");
    EXPECT_EQ(text_of(rank->shard()), "6/8");
}

TEST(Rank, mpirun_of_open_mpi_comes_before_the_slurm_that_started_it)
{
    Variables both = srun;
    both.insert({{"OMPI_COMM_WORLD_RANK", "2"},
                 {"OMPI_COMM_WORLD_SIZE", "4"},
                 {"OMPI_COMM_WORLD_LOCAL_RANK", "3"},
                 {"PMIX_NAMESPACE", "1234"}});
    const auto rank = rank_in(both);
    ASSERT_TRUE(rank);
    EXPECT_EQ(text_of(rank->shard()), "3/4");
    EXPECT_EQ(rank->local, 3u);
    EXPECT_EQ(rank->job, "1234");
}

TEST(Rank, other_launchers_are_recognised_by_pmi)
{
    Variables mpich = {{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}, {"MPI_LOCALRANKID", "1"}, {"MPI_LOCALNRANKS", "2"}};
    const auto rank = rank_in(mpich);
    ASSERT_TRUE(rank);
    EXPECT_EQ(text_of(rank->shard()), "2/2");
    EXPECT_EQ(rank->local, 1u);
    EXPECT_EQ(rank->job, "the launcher") << "all ranks are its children";
    mpich["TETRACE_LAUNCH"] = "monday";
    EXPECT_EQ(rank_in(mpich)->job, "named monday");
    mpich.insert({{"SLURM_JOB_ID", "12"}, {"SLURM_STEP_ID", "3"}});
    mpich.erase("TETRACE_LAUNCH");
    EXPECT_EQ(rank_in(mpich)->job, "slurm 12.3");
}

TEST(Rank, a_launch_on_several_machines_that_nothing_names_is_refused)
{
    Variables mpich = {{"PMI_RANK", "1"}, {"PMI_SIZE", "4"}, {"MPI_LOCALRANKID", "1"}, {"MPI_LOCALNRANKS", "2"}};
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(rank_in(mpich)); }), "set TETRACE_LAUNCH to a text"));
    mpich["TETRACE_LAUNCH"] = "monday";
    EXPECT_EQ(rank_in(mpich)->job, "named monday");
    EXPECT_FALSE(rank_in({{"PMI_RANK", "0"}, {"PMI_SIZE", "1"}})) << "a single process needs no name";
}

TEST(Rank, the_launcher_is_the_ancestor_that_is_no_rank_itself)
{
    EXPECT_TRUE(launcher_name().starts_with("launcher ")) << launcher_name();
    EXPECT_EQ(launcher_name(), launcher_name());
}

TEST(Rank, a_single_process_is_not_a_rank)
{
    EXPECT_FALSE(rank_in({}));
    EXPECT_FALSE(rank_in({{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "1"}}));
    Variables batch_script = srun;
    batch_script.erase("SLURM_STEP_ID");
    EXPECT_FALSE(rank_in(batch_script)) << "a batch script has SLURM_PROCID and SLURM_NTASKS, and runs once";
}

TEST(Rank, an_environment_that_contradicts_itself_is_refused)
{
    const auto refusal = [](const Variables& variables) {
        return error_of([&] { static_cast<void>(rank_in(variables)); });
    };
    EXPECT_TRUE(
        contains(refusal({{"PMI_RANK", "2"}, {"PMI_SIZE", "2"}}), "process 2 of 2, from 0 (PMI_RANK, PMI_SIZE)"));
    EXPECT_TRUE(contains(refusal({{"PMI_RANK", "one"}, {"PMI_SIZE", "2"}}), "PMI_RANK is 'one'"));
}
