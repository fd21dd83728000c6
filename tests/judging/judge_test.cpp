// The verbs `rays` and `judge` as programs meet them.
#include "bench/results/npy.h"
#include "core/base/files.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class JudgeProgram : public ProgramTest {
protected:
    void make_rays(const std::string& options)
    {
        const Ended made = run("rays --scene cubes --out rays.npy --answers hits.npy " + options);
        ASSERT_EQ(made.code, 0) << made.errors;
    }
    Ended judge(const std::string& options = {})
    {
        return run("judge --mesh cubes --ray-file rays.npy --hits hits.npy " + options);
    }
    [[nodiscard]] std::vector<float> hits() const
    {
        const NpyArray array = read_npy(folder_ / "hits.npy", 4, "answers");
        return {array.values.begin(), array.values.end()};
    }
    /// The file's numbers as float64.
    void widen(const char* name, std::size_t columns)
    {
        const NpyArray array = read_npy(folder_ / name, columns, "numbers");
        std::string header =
            fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}\n", array.rows, columns);
        std::string bytes("\x93NUMPY\1\0", 8);
        bytes += {static_cast<char>(header.size()), '\0'};
        bytes += header;
        bytes.append(reinterpret_cast<const char*>(array.values.data()), 8 * array.values.size());
        write_file(folder_ / name, bytes);
    }
    /// Null: there is none. Debian's numpy is for Debian's python3, which may not be the first in PATH.
    static const char* python_with_numpy()
    {
        for (const char* const candidate : {"/usr/bin/python3", "python3"})
            if (std::system(fmt::format("{} -c 'import numpy' 2> /dev/null", candidate).c_str()) == 0) return candidate;
        return nullptr;
    }
    nlohmann::json result() { return nlohmann::json::parse(file("judged.json")).at("tetrace").at("judged"); }
};

} // namespace

TEST_F(JudgeProgram, finds_its_own_answers_right)
{
    make_rays("--count 2000");
    const Ended judged = judge("--out judged.json --junit judged.xml");
    EXPECT_EQ(judged.code, 0) << judged.out << judged.errors;
    const auto json = result();
    EXPECT_EQ(json.at("rays"), 6000);
    EXPECT_EQ(json.at("faults"), 0);
    EXPECT_GT(json.at("verdicts").at("tie"), 100) << "hard rays pass through edges";
    EXPECT_NE(file("judged.xml").find("failures=\"0\""), std::string::npos) << file("judged.xml");
    widen("rays.npy", 8);
    EXPECT_EQ(judge().code, 0) << "float64 holds each float32; the answers' precision counts";
}

TEST_F(JudgeProgram, finds_each_fault_and_prints_the_first)
{
    make_rays("--rays random --count 1000");
    auto answers = hits();
    std::vector<std::size_t> met, empty;
    for (std::size_t i = 0; i < answers.size() / 4; ++i)
        (answers[4 * i] < 0 ? empty : met).push_back(i);
    ASSERT_GT(met.size(), 10u);
    ASSERT_GT(empty.size(), 10u);
    answers[4 * met[3]] = -1;          // missed
    answers[4 * met[4]] += 1;          // wrong
    answers[4 * met[5] + 1] *= 1.001f; // inaccurate
    answers[4 * empty[6]] = 0;         // invented
    write_npy(folder_ / "hits.npy", 4, answers);
    const Ended judged = judge("--out judged.json --junit judged.xml");
    EXPECT_EQ(judged.code, 1) << judged.errors;
    const std::size_t first = std::min({met[3], met[4], met[5], empty[6]});
    EXPECT_NE(judged.out.find(fmt::format("First fault: ray {}", first)), std::string::npos) << judged.out;
    EXPECT_NE(judged.out.find("4 of 1,000 answers are faults"), std::string::npos) << judged.out;
    for (const char* const kind : {"missed", "wrong", "inaccurate", "invented"})
        EXPECT_EQ(result().at("verdicts").at(kind), 1) << kind;
    EXPECT_EQ(result().at("first_faults").size(), 4u);
    EXPECT_NE(file("judged.xml").find("failures=\"4\""), std::string::npos) << file("judged.xml");
}

TEST_F(JudgeProgram, refuses_what_does_not_fit_with_exit_code_2)
{
    make_rays("--rays random --count 10");
    write_npy(folder_ / "nine.npy", 4, std::vector<float>(36));
    const struct {
        const char *arguments, *says;
        int code = 2;
    } cases[] = {
        {"judge --mesh cubes --ray-file rays.npy", "--hits FILE.npy is missing"},
        {"judge --mesh cubes --hits hits.npy", "--ray-file FILE.npy is missing"},
        {"judge --ray-file rays.npy --hits hits.npy", "--mesh MESH is missing"},
        {"judge --mesh cubes --ray-file", "--ray-file needs a value: FILE.npy"},
        {"judge --mesh cubes --ray-file hits.npy --hits hits.npy", "N x 8"},
        {"judge --mesh cubes --ray-file rays.npy --hits nine.npy", "nine.npy has 9 answers"},
        {"judge --mesh bunny-1 --ray-file rays.npy --hits hits.npy", "cleaned and placed"},
        {"judge --mesh cubes --ray-file rays.npy --hits hits.npy --slack 0", "--slack"},
        {"judge --mesh cubes --ray-file rays.npy --hits none.npy", "none.npy", 3},
        {"rays --scene cubes", "--out FILE.npy is missing"},
        {"rays --scene cubes --out new.npy --answers ./new.npy", "it is the file of --out"},
        {"rays --scene cubes --out rays.txt", "does not end in .npy"},
        {"rays --scene cubes --out new.npy --count 10000001", "--count"},
        {"rays --scene cubes --rays shadow --out rays.npy", "primary, random or hard"},
        {"rays --scene cubes,bunny --out rays.npy", "given several times"},
    };
    for (const auto& [arguments, says, code] : cases) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, code) << arguments << "\n" << ended.errors;
        EXPECT_NE(ended.errors.find(says), std::string::npos) << ended.errors << "\nlacks " << says;
    }
}

namespace {

/// Large coordinates, a vertex that is there twice, and a first face without area, which a scene would drop.
constexpr const char* plain_mesh = "v 4000 0 0\nv 4001 0 0\nv 4001 1 0\nv 4000 1 0\nv 4000 0 0\nv 4000 0 -1\n"
                                   "f 1 2 5\nf 5 2 3\nf 1 3 4\nf 1 2 6\nf 2 3 6\nf 3 4 6\nf 4 1 6\n";

bool has_builder()
{
    return std::filesystem::exists(std::filesystem::path(TETRACE_PROGRAM).parent_path() / "tetrace-builder");
}

} // namespace

TEST_F(JudgeProgram, takes_a_mesh_as_its_file_has_it)
{
    if (!has_builder()) GTEST_SKIP() << "tetrace-builder, which reads meshes, is not built here";
    write_file(folder_ / "plain.obj", plain_mesh);
    write_npy(folder_ / "rays.npy", 8, std::vector<float>{4000.75f, 0.25f, 1, 0, 0, 0, -2, HUGE_VALF});
    write_npy(folder_ / "hits.npy", 4, std::vector<float>{1, 0.5f, 0.5f, 0.25f});
    const Ended judged = run("judge --mesh plain.obj --ray-file rays.npy --hits hits.npy");
    EXPECT_EQ(judged.code, 0) << judged.out << judged.errors;
    EXPECT_EQ(run("rays --scene plain.obj --count 500 --out r.npy --answers a.npy").code, 0);
    EXPECT_EQ(run("judge --mesh plain.obj --ray-file r.npy --hits a.npy").code, 0);
}

TEST_F(JudgeProgram, example_with_numpy_in_the_documentation_works)
{
    const char* const python = python_with_numpy();
    if (python == nullptr) GTEST_SKIP() << "python3-numpy is not installed";
    if (!has_builder()) GTEST_SKIP() << "tetrace-builder, which reads meshes, is not built here";
    const std::string page = read_text(std::filesystem::path(TETRACE_DOCS) / "judge.md");
    const std::string begin = "```python\n";
    const std::size_t from = page.find(begin) + begin.size();
    write_file(folder_ / "trace.py", page.substr(from, page.find("```", from) - from));
    write_file(folder_ / "mesh.obj", plain_mesh);
    ASSERT_EQ(run("rays --scene mesh.obj --rays random --count 500 --out rays.npy").code, 0);
    const Ended traced = run("trace.py", python);
    ASSERT_EQ(traced.code, 0) << traced.errors;
    const Ended judged = run("judge --mesh mesh.obj --ray-file rays.npy --hits hits.npy");
    EXPECT_EQ(judged.code, 0) << judged.out << judged.errors;
}

// scripts/how-wrong on one mesh: its corpus has the right answers, and tetrace's are right for rays that are not hard.
TEST_F(JudgeProgram, script_of_how_wrong_ray_tracers_are_judges_them_on_a_corpus)
{
    const char* const python = python_with_numpy();
    if (python == nullptr) GTEST_SKIP() << "python3-numpy is not installed";
    const auto library = std::filesystem::path(TETRACE_PROGRAM).parent_path() / "libtetrace.so.0.1";
    if (!has_builder() || !std::filesystem::exists(library)) GTEST_SKIP() << "the library is not built here";
    const Ended ran = run(fmt::format("'{}/scripts/how-wrong' '{}' corpus --meshes boxes --count 100 --size 16 "
                                      "--out how.md",
                                      TETRACE_ROOT, TETRACE_PROGRAM),
                          python);
    ASSERT_EQ(ran.code, 0) << ran.out << ran.errors;
    const Ended judged = run("judge --mesh corpus/boxes.obj --ray-file corpus/boxes-hard.npy "
                             "--hits corpus/boxes-hard-answers.npy --out judged.json");
    EXPECT_EQ(judged.code, 0) << judged.out << judged.errors;
    EXPECT_EQ(result().at("rays"), 100);
    const std::string page = file("how.md");
    for (const char* const line : {"| bvh2 | 300 |", "| project half32 | 300 |", "| stp tet80, openmp | 256 |"})
        EXPECT_NE(page.find(line), std::string::npos) << page;
    const std::size_t random = page.find("| random |");
    ASSERT_NE(random, std::string::npos) << page;
    EXPECT_TRUE(page.substr(random, page.find('\n', random) - random)
                    .ends_with("| 0 / 0 / 0 / 0 | 0 / 0 / 0 / 0 | 0 / 0 / 0 / 0 | 0 / 0 / 0 / 0 |"))
        << page;
}
