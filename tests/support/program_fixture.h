#pragma once

#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <string>
#include <sys/wait.h>

namespace tetrace::test {

/// How a run of the program ended.
struct Ended {
    int code = -1;
    std::string out, errors;
};

/// The program TETRACE_PROGRAM in a folder of its own, with a cache of its own.
class ProgramTest : public testing::Test {
protected:
    Ended run(const std::string& arguments, const char* program = TETRACE_PROGRAM)
    {
        const auto out = folder_.path() / "stdout", errors = folder_.path() / "stderr";
        const std::string command =
            fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' '{1}' {2} > '{3}' 2> '{4}'", folder_.path().string(),
                        program, arguments, out.string(), errors.string());
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(errors)};
    }

    /// Keeps nine rows, which every machine can run: of Embree's packets and streams some depend on processor and
    /// version.
    static constexpr const char* nine_rows = " --filter 'api:openmp$|single/embree/' ";

    Ended bench(const std::string& arguments)
    {
        // Not on this machine's GPU interfaces, whose number nobody knows.
        return run("bench --backend openmp,embree --scene cubes --resolution 6 --size 24 --samples 3 --sample-time 0 " +
                   arguments);
    }

    /// Puts the result of bench(arguments) into the folder under a name. The program measures once for all tests of a
    /// process that want the same: for tests of what is done with a result.
    void have_measured(const std::string& name, const std::string& arguments = {})
    {
        static std::map<std::string, std::string> results;
        std::string& result = results[arguments];
        if (result.empty()) {
            const Ended ended = bench(arguments + " --out measured.json");
            ASSERT_EQ(ended.code, 0) << ended.errors;
            result = file("measured.json");
            std::filesystem::remove(folder_ / "measured.json");
        }
        write_file(folder_ / name, result);
    }

    [[nodiscard]] std::string file(const char* name) const { return read_text(folder_.path() / name); }

    TemporaryFolder folder_;
};

} // namespace tetrace::test
