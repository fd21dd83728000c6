#include "scenes/child_process.h"

#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <iterator>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using End = ChildOutcome::End;

ChildOutcome shell(const std::string& script, const ChildLimits& limits = {})
{
    return run_child("/bin/sh", {"-c", script}, limits);
}

/// Whether the process is gone: a zombie that waits for some other parent counts as gone.
bool gone(pid_t pid)
{
    const std::string status = read_text("/proc/" + std::to_string(pid) + "/stat");
    return status.empty() || status.find(") Z ") != std::string::npos || status.find(") X ") != std::string::npos;
}

::testing::AssertionResult gone_soon(pid_t pid)
{
    for (int i = 0; i < 1000 && !gone(pid); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (gone(pid)) return ::testing::AssertionSuccess();
    ::kill(pid, SIGKILL);
    return ::testing::AssertionFailure() << "process " << pid << " is still there";
}

std::size_t open_files()
{
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Sends signals to this process once the child has said that it runs.
ChildOutcome shell_interrupted_by(int signal, const std::string& script, int times = 1, const ChildLimits& limits = {})
{
    std::thread sender;
    const auto send = [=] {
        for (int i = 0; i < times; ++i) {
            if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(300)); // signals that wait are one
            ::kill(::getpid(), signal);
        }
    };
    ChildOutcome outcome = run_child("/bin/sh", {"-c", script}, limits, [&](const std::string& line) {
        if (line == "ready") sender = std::thread(send);
    });
    sender.join();
    return outcome;
}

} // namespace

TEST(ChildProcess, reports_exit_code_and_both_streams)
{
    const ChildOutcome outcome = shell("echo out; echo err >&2; exit 7");
    EXPECT_EQ(outcome.end, End::exited);
    EXPECT_EQ(outcome.code, 7);
    EXPECT_EQ(outcome.out, "out\n");
    EXPECT_EQ(outcome.errors, "err\n");
    EXPECT_GT(outcome.wall_s, 0);
}

TEST(ChildProcess, passes_arguments_as_they_are)
{
    const ChildOutcome outcome =
        run_child("/bin/sh", {"-c", "printf '%s|' \"$@\"", "sh", "a b", "", "$HOME;'\"", "*"}, {});
    EXPECT_EQ(outcome.out, "a b||$HOME;'\"|*|");
}

TEST(ChildProcess, gives_an_empty_standard_input)
{
    EXPECT_EQ(shell("cat; echo end").out, "end\n");
}

TEST(ChildProcess, gives_no_open_file_but_the_standard_streams)
{
    const int open = ::fcntl(STDERR_FILENO, F_DUPFD, 50); // as a library leaves it, that does not know of the child
    ASSERT_GE(open, 50);
    const ChildOutcome outcome = shell("ls /proc/$$/fd");
    ::close(open);
    if (const std::string kernel = read_text("/proc/sys/kernel/osrelease"); kernel.starts_with("5.10"))
        GTEST_SKIP() << "Linux 5.11 is needed, this is " << kernel;
    EXPECT_FALSE(outcome.out.find(std::to_string(open)) != std::string::npos) << outcome.out;
}

TEST(ChildProcess, gains_no_privileges)
{
    EXPECT_TRUE(contains(shell("grep NoNewPrivs /proc/self/status").out, "1"));
}

TEST(ChildProcess, writes_no_file_over_its_limit)
{
    TemporaryFolder folder;
    const std::string script = "head -c 100000 /dev/zero > '" + (folder / "file").string() + "'; echo $?";
    EXPECT_EQ(shell(script, {.file_bytes = 50'000}).out, "153\n") << "128 and SIGXFSZ";
    EXPECT_EQ(std::filesystem::file_size(folder / "file"), 50'000u);
    EXPECT_EQ(shell(script, {.file_bytes = 200'000}).out, "0\n");
}

TEST(ChildProcess, reports_the_signal_that_ended_the_child)
{
    for (const int signal : {SIGSEGV, SIGABRT, SIGKILL}) {
        const ChildOutcome outcome = shell("kill -" + std::to_string(signal) + " $$");
        EXPECT_EQ(outcome.end, End::signalled);
        EXPECT_EQ(outcome.code, signal);
    }
}

TEST(ChildProcess, names_a_program_that_cannot_be_started)
{
    TemporaryFolder folder;
    write_file(folder / "text", "no program");
    for (const std::filesystem::path& program : {folder / "none", folder / "text", folder.path()}) {
        const std::string error = error_of([&] { (void)run_child(program, {}, {}); });
        EXPECT_TRUE(contains(error, "missing: starting " + program.string()));
    }
}

TEST(ChildProcess, hands_on_whole_lines_of_errors_as_they_come)
{
    std::vector<std::string> lines;
    const std::string script = "printf one >&2; sleep 0.1; printf ' line\\n\\nlast' >&2";
    (void)run_child("/bin/sh", {"-c", script}, {}, [&](const std::string& line) { lines.push_back(line); });
    EXPECT_EQ(lines, (std::vector<std::string>{"one line", "", "last"}));
}

TEST(ChildProcess, ticks_while_the_child_is_silent)
{
    std::vector<double> ticks;
    (void)run_child("/bin/sh", {"-c", "sleep 1"}, {}, {}, [&](double elapsed_s) { ticks.push_back(elapsed_s); });
    ASSERT_GE(ticks.size(), 3u);
    EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
}

TEST(ChildProcess, keeps_the_tail_of_a_flood_and_loses_no_line)
{
    std::size_t count = 0;
    std::string last;
    const std::string script = "yes | head -n 3000000; seq 1 300000 >&2; echo done";
    const ChildOutcome outcome = run_child("/bin/sh", {"-c", script}, {}, [&](const std::string& line) {
        ++count;
        last = line;
    });
    EXPECT_EQ(outcome.out.size(), 64u * 1024);
    EXPECT_EQ(outcome.out.substr(outcome.out.size() - 7), "y\ndone\n");
    EXPECT_EQ(outcome.errors.size(), 64u * 1024);
    EXPECT_EQ(count, 300000u);
    EXPECT_EQ(last, "300000");
}

TEST(ChildProcess, bounds_a_line_that_never_ends)
{
    std::size_t longest = 0, sum = 0;
    (void)run_child("/bin/sh", {"-c", "head -c 1000000 /dev/zero >&2"}, {}, [&](const std::string& line) {
        longest = std::max(longest, line.size());
        sum += line.size();
    });
    EXPECT_EQ(sum, 1000000u);
    EXPECT_EQ(longest, 64u * 1024);
}

TEST(ChildProcess, ends_a_child_at_its_time_limit)
{
    const ChildOutcome outcome = shell("exec sleep 60", {.time_s = 0.3, .memory_bytes = 0});
    EXPECT_EQ(outcome.end, End::timed_out);
    EXPECT_EQ(outcome.code, SIGTERM);
    EXPECT_GE(outcome.wall_s, 0.3);
}

TEST(ChildProcess, ends_a_child_at_its_limit_of_processor_time)
{
    const ChildOutcome busy = shell("while :; do :; done", {.processor_s = 0.1});
    EXPECT_EQ(busy.end, End::timed_out);
    EXPECT_GE(busy.processor_s, 0.1);
    const ChildOutcome asleep = shell("exec sleep 0.5", {.processor_s = 0.1});
    EXPECT_EQ(asleep.end, End::exited) << "waiting takes none";
    EXPECT_LT(asleep.processor_s, 0.1);
}

TEST(ChildProcess, kills_a_child_that_ignores_being_asked)
{
    const ChildOutcome outcome = shell("trap '' TERM; sleep 60; sleep 60", {.time_s = 0.3, .memory_bytes = 0});
    EXPECT_EQ(outcome.end, End::timed_out);
    EXPECT_EQ(outcome.code, SIGKILL);
}

TEST(ChildProcess, sees_the_time_limit_of_a_child_that_floods)
{
    EXPECT_EQ(shell("exec yes", {.time_s = 0.3, .memory_bytes = 0}).end, End::timed_out);
}

TEST(ChildProcess, ends_the_child_s_own_children_too)
{
    const ChildOutcome slow = shell("sleep 60 & echo $!; wait", {.time_s = 0.3, .memory_bytes = 0});
    EXPECT_EQ(slow.end, End::timed_out);
    EXPECT_TRUE(gone_soon(static_cast<pid_t>(std::stol(slow.out))));
    // One that outlives its parent and keeps the pipes open holds nobody up.
    const ChildOutcome quick = shell("sleep 60 & echo $!");
    EXPECT_EQ(quick.end, End::exited);
    EXPECT_LT(quick.wall_s, 60);
    EXPECT_TRUE(gone_soon(static_cast<pid_t>(std::stol(quick.out))));
}

TEST(ChildProcess, limits_the_child_s_memory)
{
    const std::string script = "x=$(head -c 60000000 /dev/zero | tr '\\0' x); echo ${#x}";
    EXPECT_EQ(shell(script).out, "60000000\n");
    const ChildOutcome outcome = shell(script, {.time_s = 0, .memory_bytes = 32 << 20});
    EXPECT_NE(outcome.out, "60000000\n");
    EXPECT_TRUE(outcome.end != End::exited || outcome.code != 0) << outcome.errors;
}

TEST(ChildProcess, ends_the_child_when_this_process_is_interrupted)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before {
        }, ours{};
        ours.sa_handler = SIG_DFL; // whoever runs the tests may have it ignored
        ::sigaction(signal, &ours, &before);
        const ChildOutcome outcome = shell_interrupted_by(signal, "echo ready >&2; exec sleep 60");
        EXPECT_EQ(outcome.end, End::interrupted);
        struct sigaction after {};
        ::sigaction(signal, &before, &after);
        EXPECT_EQ(after.sa_handler, SIG_DFL) << "the handler was not restored";
    }
}

TEST(ChildProcess, lets_a_child_finish_after_one_interrupt_where_it_may)
{
    struct sigaction before {
    }, ours{};
    ours.sa_handler = SIG_DFL;
    ::sigaction(SIGINT, &ours, &before);
    const ChildLimits patient = {.finish_s = 60};
    const std::string loop = "echo ready >&2; while :; do sleep 0.02; done";
    const ChildOutcome finished = shell_interrupted_by(SIGINT, "trap 'echo end; exit 0' INT; " + loop, 1, patient);
    EXPECT_EQ(finished.end, End::exited);
    EXPECT_TRUE(finished.interrupted);
    EXPECT_EQ(finished.out, "end\n");
    const ChildOutcome ended = shell_interrupted_by(SIGINT, "echo ready >&2; exec sleep 60", 1, patient);
    EXPECT_EQ(ended.end, End::interrupted) << "it has nothing to finish";
    const ChildOutcome twice = shell_interrupted_by(SIGINT, "trap '' INT; " + loop, 2, patient);
    EXPECT_EQ(twice.end, End::interrupted) << "the second ends it";
    const ChildOutcome late = shell_interrupted_by(SIGINT, "trap '' INT; " + loop, 1, {.finish_s = 0.3});
    EXPECT_EQ(late.end, End::interrupted) << "its time is over";
    EXPECT_FALSE(run_child("/bin/true", {}, patient).interrupted);
    ::sigaction(SIGINT, &before, nullptr);
}

TEST(ChildProcess, leaves_an_ignored_interrupt_ignored)
{
    struct sigaction before {
    }, ignore{};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGINT, &ignore, &before);
    const ChildOutcome outcome = shell_interrupted_by(SIGINT, "echo ready >&2; sleep 0.5; echo end");
    EXPECT_EQ(outcome.end, End::exited);
    EXPECT_EQ(outcome.out, "end\n");
    ::sigaction(SIGINT, &before, nullptr);
}

TEST(ChildProcess, dies_with_its_parent)
{
    TemporaryFolder folder;
    const std::filesystem::path file = folder / "pid";
    const pid_t parent = ::fork();
    ASSERT_GE(parent, 0);
    if (parent == 0) {
        (void)shell("echo $$ > " + file.string() + ".new; mv " + file.string() + ".new " + file.string() +
                    "; exec sleep 60");
        ::_exit(0);
    }
    while (!std::filesystem::exists(file))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const auto child = static_cast<pid_t>(std::stol(read_text(file)));
    EXPECT_FALSE(gone(child));
    ::kill(parent, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(parent, &status, 0), parent);
    EXPECT_TRUE(gone_soon(child));
}

TEST(ChildProcess, ends_the_child_when_a_callback_throws)
{
    pid_t child = 0;
    EXPECT_THROW((void)run_child("/bin/sh", {"-c", "echo $$ >&2; exec sleep 60"}, {},
                                 [&](const std::string& line) {
                                     child = static_cast<pid_t>(std::stol(line));
                                     throw std::runtime_error("enough");
                                 }),
                 std::runtime_error);
    EXPECT_TRUE(gone_soon(child));
}

TEST(ChildProcess, leaves_no_zombie_and_no_open_file)
{
    (void)shell("true");
    const std::size_t before = open_files();
    for (int i = 0; i < 20; ++i)
        (void)shell("echo x");
    (void)error_of([] { (void)run_child("/no/such/program", {}, {}); });
    EXPECT_EQ(open_files(), before);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

TEST(ChildProcess, runs_from_several_threads_at_once)
{
    std::vector<std::thread> threads;
    std::atomic<int> right{0};
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&right, i] {
            const ChildOutcome outcome = shell("sleep 0.1; exit " + std::to_string(i));
            if (outcome.end == End::exited && outcome.code == i) ++right;
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(right, 4);
}
