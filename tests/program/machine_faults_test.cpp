// The program on a machine that fails: rows of docs/faults.md.
#include "tests/reproduce/reproduce_fixture.h"

#include <csignal>
#include <thread>

using namespace tetrace;
using namespace tetrace::test;
using Json = nlohmann::json;

namespace {

class MachineFaults : public ReproduceTest {
protected:
    [[nodiscard]] Ended run_on_faulty_disk(const std::string& fault, const std::string& arguments) const
    {
        const ScopedVariable disk("LD_PRELOAD", TETRACE_FAULTY_DISK), how("FAULTY_DISK", fault);
        return run(arguments);
    }
    /// A short run of any verb, in this folder.
    [[nodiscard]] Ended verb(const std::string& arguments, const std::string& before = "exec") const
    {
        const std::string command = fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' {1} '{2}' {3} --backend openmp "
                                                "--scene cubes --resolution 4 --layout "
                                                "tet80 --size 24 --threads 2 > stdout 2> stderr",
                                                folder_.path().string(), before, TETRACE_PROGRAM, arguments);
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }
    /// What a result says of its rows, but for times.
    [[nodiscard]] Json answers(const std::string& name) const
    {
        const Json all = result(name);
        Json answers;
        for (const Json& row : all.at("rows"))
            answers.push_back({row.at("name"), row.at("status"), row.at("hit_hash"), row.at("verification")});
        EXPECT_FALSE(answers.empty());
        return answers;
    }
    [[nodiscard]] bool has_temporary_files() const
    {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
            if (entry.path().extension() == ".tmp") return true;
        return false;
    }

    std::string table4_ = "table4 --method maria,ms06 --layout tet80 --size 32 --views 0-1281:160 --out ";
};

} // namespace

TEST_F(MachineFaults, disk_that_takes_only_some_bytes_at_a_time_costs_nothing)
{
    EXPECT_EQ(run_on_faulty_disk("write short", table4_ + "short.json").code, 0);
    EXPECT_EQ(run(table4_ + "whole.json").code, 0);
    EXPECT_EQ(answers("short.json"), answers("whole.json"));
}

TEST_F(MachineFaults, disk_that_fails_at_any_line_of_a_journal_ends_the_run_and_resume_goes_on_to_the_same_result)
{
    ASSERT_EQ(run(table4_ + "whole.json").code, 0);
    for (const char* fault : {"write:1 io", "write:3 full", "sync:4 io", "write:9 io"}) {
        std::filesystem::remove(folder_ / "r.json.journal");
        const Ended ended = run_on_faulty_disk(fault, table4_ + "r.json");
        EXPECT_EQ(ended.code, 2) << fault << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "writing the journal 'r.json.journal': ")) << fault;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "r.json")) << fault;
        EXPECT_EQ(run(table4_ + "r.json --resume").code, 0) << fault;
        EXPECT_EQ(answers("r.json"), answers("whole.json")) << fault;
        std::filesystem::remove(folder_ / "r.json");
    }
}

TEST_F(MachineFaults, disk_that_fails_at_the_result_leaves_the_one_before_it)
{
    write_file(folder_ / "r.json", "before");
    for (const char* fault : {"write io", "write full", "sync io", "rename io"}) {
        const ScopedVariable disk("LD_PRELOAD", TETRACE_FAULTY_DISK), how("FAULTY_DISK", fault);
        const Ended ended = verb("check --out r.json");
        EXPECT_EQ(ended.code, 2) << fault << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "r.json")) << fault;
        EXPECT_EQ(read_text(folder_ / "r.json"), "before") << fault;
        EXPECT_FALSE(has_temporary_files()) << fault;
    }
}

TEST_F(MachineFaults, signal_that_ends_a_run_costs_only_what_was_not_finished)
{
    const std::string arguments = "table4 --method maria --layout tet80 --size 32 --views 0-1281:160 --out ";
    ASSERT_EQ(run(arguments + "whole.json").code, 0);
    for (const int signal : {SIGTERM, SIGINT}) {
        const Ended ended = end(start(arguments + "r.json", 3, signal));
        EXPECT_EQ(ended.code, 130) << ended.errors;
        EXPECT_TRUE(contains(read_text(folder_ / "r.json"), "\"interrupted\":true"));
        EXPECT_EQ(run(arguments + "r.json --resume").code, 0);
        EXPECT_EQ(answers("r.json"), answers("whole.json"));
        std::filesystem::remove(folder_ / "r.json");
        std::filesystem::remove(folder_ / "r.json.journal");
    }
}

TEST_F(MachineFaults, second_run_of_a_journal_is_refused_and_the_first_goes_on)
{
    const std::string arguments = "table4 --method maria --layout tet80 --size 32 --views 0-1281:160 --out r.json";
    const pid_t first = start(arguments, 3, SIGSTOP);
    siginfo_t stopped{};
    ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(first), &stopped, WSTOPPED | WEXITED | WNOWAIT), 0);
    ASSERT_EQ(stopped.si_code, CLD_STOPPED);
    const Ended second = run(arguments + " --resume");
    ::kill(first, SIGCONT);
    EXPECT_EQ(second.code, 2);
    EXPECT_TRUE(contains(second.errors, "is being written by another run"));
    EXPECT_EQ(end(first).code, 0);
    EXPECT_EQ(answers("r.json").size(), 1u);
}

TEST_F(MachineFaults, two_runs_into_one_file_leave_the_whole_result_of_one)
{
    const std::string bench = "bench --method maria,stp --samples 3 --sample-time 0 --out b.json";
    Ended theirs;
    std::thread other([&] { theirs = verb(bench, "exec"); });
    const Ended ours = verb(bench);
    other.join();
    EXPECT_TRUE(ours.code == 0 || theirs.code == 0) << ours.errors << theirs.errors;
    for (const Ended& ended : {ours, theirs})
        EXPECT_TRUE(ended.code == 0 || contains(ended.errors, "is being written by another run")) << ended.errors;
    EXPECT_EQ(answers("b.json").size(), 2u);
    EXPECT_FALSE(has_temporary_files());
}

TEST_F(MachineFaults, clock_of_the_day_that_jumps_changes_no_answer_and_no_rate)
{
    ASSERT_EQ(verb("bench --samples 5 --sample-time 0 --out still.json").code, 0);
    const ScopedVariable clock("LD_PRELOAD", TETRACE_JUMPING_CLOCK);
    const Ended ended = verb("bench --samples 5 --sample-time 0 --out jumping.json");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(answers("jumping.json"), answers("still.json"));
    const Json jumping = result("jumping.json");
    for (const Json& sample : jumping["rows"][0]["times"]["samples_s"])
        EXPECT_LT(sample.get<double>(), 60.0) << "a jump is a day at least";
    EXPECT_LT(jumping["timed_s"].get<double>(), 3600.0);
    EXPECT_EQ(verb("check").code, 0);
    EXPECT_EQ(run(table4_ + "r.json").code, 0);
}

TEST_F(MachineFaults, folder_that_may_not_be_written_to_is_named_before_any_work)
{
    if (::getuid() == 0 && verb("--version", "setpriv --reuid=65534 --regid=65534 --clear-groups").code != 0)
        GTEST_SKIP() << "no user but root may run the program here";
    std::filesystem::create_directories(folder_ / "closed");
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
    std::filesystem::permissions(folder_ / "closed", std::filesystem::perms(0555));
    write_file(folder_ / "stdout", ""), write_file(folder_ / "stderr", "");
    const Ended ended = verb("bench --samples 3 --out closed/r.json",
                             ::getuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups" : "exec");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "closed/r.json"));
    EXPECT_TRUE(contains(ended.errors, "Permission denied"));
    EXPECT_EQ(ended.out, "");
}

TEST_F(MachineFaults, full_file_system_is_an_error_with_its_reason_and_the_next_run_is_good)
{
    write_file(folder_ / "script", "mount -t tmpfs -o size=4k none small 2>/dev/null || exit 77\n"
                                   "exec '" TETRACE_PROGRAM "' \"$@\"\n");
    std::filesystem::create_directories(folder_ / "small");
    const auto on_small_disk = [&](const std::string& arguments) {
        const int status = std::system(
            fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' unshare -m sh ./script {1} "
                        "--backend openmp --scene cubes --resolution 4 --size 32 --layout tet80 > stdout 2> stderr",
                        folder_.path().string(), arguments)
                .c_str());
        return Ended{WEXITSTATUS(status), read_text(folder_ / "stdout"), read_text(folder_ / "stderr")};
    };
    const Ended ended = on_small_disk("bench --method maria,stp --samples 20 --sample-time 0 --out small/r.json");
    if (ended.code == 77 || contains(ended.errors, "unshare")) GTEST_SKIP() << "only root can make a small file system";
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "small/r.json"));
    EXPECT_TRUE(contains(ended.errors, "No space left on device"));
    const Ended reproduce = on_small_disk("reproduce table4 --method maria --views 0-1281:160 --out small/r.json");
    EXPECT_EQ(reproduce.code, 2);
    EXPECT_TRUE(contains(reproduce.errors, "No space left on device"));
    EXPECT_EQ(on_small_disk("bench --method maria,stp --samples 3 --sample-time 0 --out r.json").code, 0);
}
