// What the program says: each thing once, in its place.
#include "tests/support/program_fixture.h"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>
#include <unistd.h>
#include <utility>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::size_t times_in(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

class Messages : public ProgramTest {
protected:
    /// A mesh that a builder finds to intersect itself, at length.
    void give_mesh_that_intersects_itself() const
    {
        write_file(folder_ / "knot.off", "OFF, as far as a shell script cares");
        write_file(folder_ / "builder", "#!/bin/sh\necho 'error: 7 pairs of triangles intersect' >&2\nexit 10\n");
        std::filesystem::permissions(folder_ / "builder", std::filesystem::perms::owner_all);
    }
};

/// A terminal whose screen is a string.
class Terminal {
public:
    Terminal()
    {
        master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
        name_ = ::ptsname(master_);
        slave_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC); // else reading ends before the program begins
        reader_ = std::thread([this] {
            char piece[4096];
            for (ssize_t size; (size = ::read(master_, piece, sizeof piece)) > 0;)
                screen_.append(piece, static_cast<std::size_t>(size));
        });
    }
    ~Terminal() { static_cast<void>(screen()); }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    /// All that was written to it; closes it.
    const std::string& screen()
    {
        if (slave_ >= 0) ::close(std::exchange(slave_, -1));
        if (reader_.joinable()) reader_.join();
        if (master_ >= 0) ::close(std::exchange(master_, -1));
        return screen_;
    }

private:
    int master_ = -1, slave_ = -1;
    std::string name_, screen_;
    std::thread reader_;
};

} // namespace

TEST_F(Messages, a_mesh_that_intersects_itself_is_reported_once_with_one_exit_code)
{
    give_mesh_that_intersects_itself();
    const ScopedVariable builder("TETRACE_BUILDER", folder_ / "builder");
    for (const char* const arguments :
         {"bench --backend openmp --scene knot.off", "check --backend openmp --scene knot.off",
          "build --scene knot.off", "build --scene knot.off --domain tight,tight", "render --scene knot.off"}) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 2) << arguments << ended.errors;
        EXPECT_EQ(times_in(ended.errors, "7 pairs of triangles"), 1u) << arguments << ended.errors;
        EXPECT_LE(times_in(ended.out, "7 pairs of triangles"), 1u) << arguments << ended.out;
        EXPECT_LT(ended.out.size(), 3000u) << arguments << ended.out;
    }
    const Ended json = run("bench --backend openmp --scene knot.off --format json");
    for (const auto& row : nlohmann::json::parse(json.out)["tetrace"]["rows"])
        EXPECT_TRUE(contains(row["reason"].get<std::string>(), "7 pairs of triangles")) << row;
}

TEST_F(Messages, a_check_that_a_signal_ends_while_a_scene_is_built_writes_junit_and_json)
{
    give_mesh_that_intersects_itself();
    const ScopedVariable builder("TETRACE_BUILDER", folder_ / "builder");
    for (const char* const signal : {"TERM", "INT"}) {
        write_file(folder_ / "builder", fmt::format("#!/bin/sh\nkill -{} $PPID\nexec sleep 60\n", signal));
        const Ended ended = run("check --backend openmp --scene knot.off,cubes --junit j.xml --out r.json");
        EXPECT_EQ(ended.code, 130) << ended.errors;
        EXPECT_TRUE(contains(file("j.xml"), "the check was interrupted")) << file("j.xml");
        EXPECT_FALSE(contains(ended.out, "self-test")) << "no device was opened: " << ended.out;
        const auto result = nlohmann::json::parse(file("r.json"))["tetrace"];
        EXPECT_EQ(result["interrupted"], true);
        for (const auto& row : result["rows"])
            EXPECT_EQ(row["status"], "skipped") << row;
        EXPECT_GT(result["rows"].size(), 2u);
        for (const char* const name : {"j.xml", "r.json", "r.json.journal"})
            std::filesystem::remove(folder_ / name);
    }
}

TEST_F(Messages, a_reason_that_many_rows_share_is_one_line)
{
    const ScopedVariable none("CUDA_VISIBLE_DEVICES", "");
    const Ended ended =
        run("bench --backend openmp,cuda --scene cubes --resolution 3 --size 16 --samples 3 --sample-time 0");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(times_in(ended.out, ": skipped: "), 1u) << ended.out;
    EXPECT_TRUE(
        contains(ended.out, " rows of cubes, such as cdt/maria/tet80/cubes/primary/math:exact/api:cuda: skipped: "))
        << ended.out;
}

TEST_F(Messages, compare_says_of_many_rows_at_once_what_holds_of_all)
{
    have_measured("few.json", "--backend openmp");
    have_measured("one.json", "--layout tet80");
    const Ended few = run("compare few.json few.json");
    EXPECT_EQ(times_in(few.out, "fewer than 5 samples, so no interval: 3 in A and 3 in B"), 1u) << few.out;
    const Ended missing = run("compare few.json one.json");
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(times_in(missing.out, "MISSING: B: no such row"), 1u) << missing.out;
    EXPECT_EQ(times_in(missing.out, "Regressed"), 1u) << missing.out;
    EXPECT_TRUE(contains(missing.out, " rows are MISSING")) << missing.out;
}

TEST_F(Messages, tables_are_in_colour_on_terminals_and_nowhere_else)
{
    have_measured("a.json");
    have_measured("b.json", "--layout tet80");
    const auto shown = [&](const std::string& more) {
        Terminal terminal;
        if (terminal.name().empty()) return std::string("no terminal");
        run("compare a.json b.json " + more + " > " + terminal.name() + " 2> /dev/null #");
        return terminal.screen();
    };
    const ScopedVariable term("TERM", "xterm");
    {
        const ScopedVariable none("NO_COLOR", static_cast<const char*>(nullptr));
        const std::string screen = shown("--out c.txt");
        if (screen == "no terminal") GTEST_SKIP() << "this system lacks pseudo-terminals";
        EXPECT_TRUE(contains(screen, "\x1b[33mMISSING\x1b[0m")) << screen;
        EXPECT_FALSE(contains(file("c.txt"), "\x1b")) << "a file has none";
        EXPECT_FALSE(contains(run("compare a.json b.json").out, "\x1b"));
    }
    const ScopedVariable refused("NO_COLOR", "1");
    EXPECT_FALSE(contains(shown(""), "\x1b"));
    EXPECT_TRUE(contains(shown(""), "MISSING"));
}

TEST_F(Messages, google_benchmarks_console_obeys_and_has_its_units_right)
{
    const auto console = [&](const std::string& more) {
        return bench("--layout tet80 --benchmark_format=console " + more);
    };
    const Ended plain = console("");
    ASSERT_EQ(plain.code, 0) << plain.errors;
    EXPECT_FALSE(contains(plain.out + plain.errors, "\x1b")) << plain.out;
    EXPECT_FALSE(contains(plain.out + plain.errors, "DEBUG")) << plain.errors;
    EXPECT_TRUE(contains(plain.errors, "Run on (")) << "the rest of what it says of the machine stays";
    EXPECT_TRUE(std::regex_search(plain.out, std::regex("Mrays/s=[0-9.]+[a-zA-Z]?\\s"))) << plain.out;
    EXPECT_TRUE(contains(console("--benchmark_color=true").out, "\x1b["));
    EXPECT_FALSE(contains(console("--benchmark_color=false").out, "\x1b["));
}

TEST_F(Messages, an_interrupted_reproduce_says_how_to_go_on)
{
    ::signal(SIGINT, SIG_DFL); // a shell's background jobs ignore it, and so would the program
    const std::string command = fmt::format(
        "cd '{0}' && LD_PRELOAD='{2}' TETRACE_KILLED_AT_SYNC=4 TETRACE_SYNC_SIGNAL={3} exec '{1}' reproduce table3 "
        "--scene cubes --resolution 3 --size 8 --backend openmp --out 'my tables.json' > out 2> errors",
        folder_.path().string(), TETRACE_PROGRAM, TETRACE_KILLING_SYNC, SIGINT);
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 130);
    EXPECT_TRUE(contains(file("errors"),
                         "to go on: tetrace reproduce table3 --scene cubes --resolution 3 --size 8 --backend "
                         "openmp --out 'my tables.json' --resume\n"))
        << file("errors");
    EXPECT_TRUE(contains(file("errors"), "is in 'my tables.json.journal'")) << file("errors");
}

TEST_F(Messages, tables_and_sentences_fit_the_terminal)
{
    have_measured("a.json");
    const ScopedVariable term("TERM", "xterm"), none("NO_COLOR", "1");
    for (const char* const columns : {"80", "60"}) {
        const ScopedVariable width("COLUMNS", columns);
        Terminal terminal;
        if (terminal.name().empty()) GTEST_SKIP() << "no terminal";
        run("show a.json > " + terminal.name() + " 2> /dev/null #");
        std::istringstream screen(terminal.screen());
        for (std::string line; std::getline(screen, line);) {
            line.erase(line.find_last_not_of('\r') + 1);
            EXPECT_LE(line.size(), std::stoul(columns)) << line;
        }
        EXPECT_TRUE(contains(terminal.screen(), std::string("Left out in ") + columns + " columns: "))
            << terminal.screen();
        EXPECT_TRUE(contains(terminal.screen(), "Mrays/s")) << terminal.screen();
    }
}

TEST_F(Messages, verdicts_of_a_check_are_there_on_a_terminal_of_any_width)
{
    const ScopedVariable term("TERM", "xterm"), none("NO_COLOR", "1");
    std::size_t all_verdicts = 0; // where all columns fit
    for (const char* const columns : {"80", "60", "40"}) {
        const ScopedVariable width("COLUMNS", columns);
        Terminal terminal;
        if (terminal.name().empty()) GTEST_SKIP() << "no terminal";
        run("check --backend openmp,cuda-host,embree --scene cubes --resolution 4 --size 16 --views 0 > " +
            terminal.name() + " 2> /dev/null #");
        const std::string screen = terminal.screen();
        std::istringstream lines(screen);
        for (std::string line; std::getline(lines, line);) {
            line.erase(line.find_last_not_of('\r') + 1);
            const bool is_one_word = line.find(' ') == std::string::npos; // such as the name of a row
            EXPECT_TRUE(is_one_word || line.size() <= std::stoul(columns)) << line;
        }
        for (const char* const title : {"  openmp", "  cuda-host", "  embree", "  wrong  lost", "  self-test"})
            EXPECT_TRUE(contains(screen, title)) << screen;
        std::size_t verdicts = 0;
        for (std::size_t at = screen.find("bit-exact"); at != std::string::npos; at = screen.find("bit-exact", at + 1))
            ++verdicts;
        if (all_verdicts == 0) all_verdicts = verdicts;
        EXPECT_GT(verdicts, 0u) << screen;
        EXPECT_EQ(verdicts, all_verdicts) << screen;
        const std::size_t left_out = screen.find("Left out in 40 columns: hit hash");
        EXPECT_EQ(left_out != std::string::npos, std::string(columns) == "40") << screen;
    }
}
