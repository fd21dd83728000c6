// Conformance must be able to fail: programs with one mistake in one backend's kernel (tests/mutants/) do not pass the
// check that the program without it passes.
#include "core/device/backend.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Why a backend cannot be tested here; empty if it can.
std::string why_not(const std::string& name)
{
    for (const Backend* backend : all_backends()) {
        if (backend->name() != name) continue;
        for (const Device& device : backend->devices())
            if (device.usable) return {};
        return backend->devices().front().reason;
    }
    return "unknown backend " + name;
}

struct MutantRun {
    int code = -1;
    std::string out;
    nlohmann::json json;
};

/// Checks one backend on a small scene with a program of the build folder.
MutantRun check(const std::string& program, const std::string& backend, const std::string& task)
{
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    const int status = std::system(
        fmt::format(
            "cd '{0}' && XDG_CACHE_HOME='{0}' '{1}/{2}' check --backend openmp,{3} --scene cubes --resolution 6 "
            "--size 48 --views 0,2 --task {4} --out result.json > out 2> errors",
            path, TETRACE_PROGRAMS, program, backend, task)
            .c_str());
    MutantRun ended{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out"), {}};
    ended.json = nlohmann::json::parse(read_text(folder / "result.json"), nullptr, false);
    EXPECT_FALSE(ended.json.is_discarded()) << read_text(folder / "errors");
    return ended;
}

/// A program with a mistake in one backend's kernel.
struct Mutant {
    const char* name;
    const char* backend;
    const char* kernel = "cdt/maria/tet80"; ///< the one with the mistake
    const char* layout = "tet80";
    const char* right_layout = "tet96"; ///< of another kernel, without it
    const char* task = "trace";
};
std::ostream& operator<<(std::ostream& out, const Mutant& mutant)
{
    return out << mutant.name;
}

class Mutants : public testing::TestWithParam<Mutant> {};

/// Whether each row of a backend's first device ended as expected.
void expect_status(const nlohmann::json& rows, const std::string& backend, const std::string& layout,
                   const char* expected)
{
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const nlohmann::json& candidate) {
        return candidate["backend"] == backend && candidate["layout"] == layout;
    });
    ASSERT_NE(row, rows.end());
    EXPECT_EQ((*row)["status"], expected) << *row;
}

} // namespace

TEST_P(Mutants, are_found_and_named_where_the_right_kernel_passes)
{
    const std::string backend = GetParam().backend;
    if (const std::string reason = why_not(backend); !reason.empty()) GTEST_SKIP() << reason;
    const MutantRun right = check("tetrace", backend, GetParam().task);
    EXPECT_EQ(right.code, 0) << right.out;
    const MutantRun wrong = check(std::string("tetrace_mutant_") + GetParam().name, backend, GetParam().task);
    EXPECT_EQ(wrong.code, 1) << wrong.out;
    EXPECT_TRUE(contains(wrong.out, GetParam().kernel + ("/cubes/primary/math:exact/api:" + backend)));
    EXPECT_TRUE(contains(wrong.out, "rays differ from openmp's, the first at view"));
    EXPECT_TRUE(contains(wrong.out, "wrong: "));
    const auto rows = wrong.json["tetrace"]["rows"];
    expect_status(rows, backend, GetParam().layout, "wrong");
    expect_status(rows, backend, GetParam().right_layout, "ok");
    expect_status(rows, "openmp", GetParam().layout, "ok");
}

INSTANTIATE_TEST_SUITE_P(
    each, Mutants,
    testing::Values(Mutant{"opencl", "opencl"}, Mutant{"vulkan", "vulkan"}, Mutant{"cuda_host_reordered", "cuda-host"},
                    Mutant{"cuda_host_fused", "cuda-host"},
                    Mutant{"cuda_host_dimmer", "cuda-host", "absorb/maria/tet80", "tet80", "half32", "absorb"},
                    Mutant{"cuda_host_bvh2", "cuda-host", "bvh/single/bvh2", "bvh2", "cwbvh"}),
    [](const auto& test) { return std::string(test.param.name); });
