#pragma once

#include "tests/support/program_fixture.h"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>

namespace tetrace::test {

/// The program's reproduce, or another verb that can be resumed, in a folder of its own, on a scene that it makes
/// itself unless another is named.
class ReproduceTest : public testing::Test {
protected:
    /// Starts it; its process. A sample is a pass unless a time is given. killed_at: the line of its journal after
    /// which it is killed, or sent another signal; 0: none.
    [[nodiscard]] pid_t start(const std::string& arguments, std::size_t killed_at = 0, int signal = SIGKILL) const
    {
        const bool names_backends = arguments.find("--backend") != std::string::npos;
        const bool names_time = verb_ == "check" || arguments.find("--sample-time") != std::string::npos;
        const bool names_scenes = arguments.find("--scene") != std::string::npos;
        std::istringstream words("tetrace " + verb_ + " " + arguments + (names_backends ? "" : " --backend openmp") +
                                 (names_scenes ? "" : " --scene cubes --resolution 6") +
                                 (names_time ? "" : " --sample-time 0") + " --threads 1");
        std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
        std::vector<char*> pointers;
        for (std::string& word : list)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t child = ::fork();
        if (child != 0) return child;
        ::signal(SIGINT, SIG_DFL); // a shell's background jobs ignore it, and so would the program
        ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
        if (killed_at > 0) {
            ::setenv("LD_PRELOAD", TETRACE_KILLING_SYNC, 1);
            ::setenv("TETRACE_KILLED_AT_SYNC", std::to_string(killed_at).c_str(), 1);
            ::setenv("TETRACE_SYNC_SIGNAL", std::to_string(signal).c_str(), 1);
        }
        if (::chdir(folder_.path().c_str()) != 0) ::_exit(126);
        ::dup2(::open("stdout", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(::open("stderr", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        ::execv(TETRACE_PROGRAM, pointers.data());
        ::_exit(127);
    }

    [[nodiscard]] Ended end(pid_t child) const
    {
        int status = 0;
        ::waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }

    [[nodiscard]] Ended run(const std::string& arguments) const { return end(start(arguments)); }

    [[nodiscard]] nlohmann::json result(const std::string& name) const
    {
        return nlohmann::json::parse(read_text(folder_ / name)).at("tetrace");
    }

    [[nodiscard]] std::size_t lines(const std::string& name) const
    {
        const std::string text = read_text(folder_ / name);
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    /// Lets the run be killed, by kill -9, when its journal has a few views, and gives back how many.
    std::size_t kill_in_the_middle(const std::string& arguments, const std::string& journal) const
    {
        EXPECT_EQ(end(start(arguments, 4)).code, -1) << "it was not killed";
        return lines(journal) - 1;
    }

    TemporaryFolder folder_;
    std::string verb_ = "reproduce";
};

/// The one of that id. Throws std::runtime_error without one.
inline const nlohmann::json& of_id(const nlohmann::json& list, std::string_view id)
{
    for (const nlohmann::json& one : list)
        if (one.at("id") == id) return one;
    throw std::runtime_error("nothing of id " + std::string(id));
}

} // namespace tetrace::test
