// The programs of docs/embed.md, built from what is installed.
#include "tests/support/temporary_folder.h"

#include <array>
#include <cstdio>
#include <regex>

using namespace tetrace::test;

namespace {

const std::filesystem::path examples = std::filesystem::path(TETRACE_DOCS) / "examples";

std::string page()
{
    return read_text(std::filesystem::path(TETRACE_DOCS) / "embed.md");
}

/// What a shell's command line prints, and its exit code at the end if that is not 0.
std::string output_of(const std::string& command)
{
    std::FILE* const pipe = popen(("(" + command + ") 2>&1").c_str(), "r");
    std::string text;
    std::array<char, 4096> piece{};
    while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe))
        text.append(piece.data(), size);
    if (const int status = pclose(pipe); status != 0) text += "exit code " + std::to_string(status >> 8) + "\n";
    return text;
}

/// Installed once for all tests of this process.
class Embedded : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<TemporaryFolder>();
        const std::string log = output_of(
            "'" TETRACE_CMAKE "' --install '" TETRACE_BUILD "' --component library --prefix '" + prefix() + "'");
        ASSERT_FALSE(contains(log, "exit code")) << log;
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string prefix() { return (*folder_ / "prefix").string(); }
    static std::string built() { return (*folder_ / "built").string(); }

    static inline std::unique_ptr<TemporaryFolder> folder_;
};

} // namespace

TEST_F(Embedded, page_quotes_the_programs_that_are_tested)
{
    for (const auto& [file, language] :
         {std::pair("trace.cpp", "cpp"), std::pair("CMakeLists.txt", "cmake"), std::pair("trace.py", "python")})
        EXPECT_TRUE(contains(page(), "```" + std::string(language) + "\n" + read_text(examples / file) + "```\n"))
            << file;
}

TEST_F(Embedded, program_is_built_with_find_package_and_prints_what_the_page_shows)
{
    const std::string log =
        output_of("'" TETRACE_CMAKE "' -G '" TETRACE_GENERATOR "' -DCMAKE_CXX_COMPILER='" TETRACE_CXX
                  "' -DCMAKE_CXX_FLAGS='-Wall -Wextra -Werror' -DCMAKE_PREFIX_PATH='" +
                  prefix() + "' -S '" + examples.string() + "' -B '" + built() + "' && '" TETRACE_CMAKE "' --build '" +
                  built() + "'");
    ASSERT_FALSE(contains(log, "exit code")) << log;
    EXPECT_TRUE(contains(page(), "```\n$ build/trace\n" + output_of("'" + built() + "/trace'") + "```\n"));
    const std::string refused = output_of("'" + built() + "/trace' cubs");
    EXPECT_TRUE(contains(refused, "scene cubs: neither a name of the catalogue"));
    EXPECT_TRUE(contains(refused, "exit code 1"));
}

TEST_F(Embedded, numpy_program_prints_what_the_page_shows)
{
    std::string python;
    for (const char* const candidate : {"/usr/bin/python3", "python3"})
        if (python.empty() && output_of(std::string(candidate) + " -c 'import numpy'").empty()) python = candidate;
    if (python.empty()) GTEST_SKIP() << "skipped: numpy is not installed (python3-numpy)";
    EXPECT_TRUE(contains(page(), "```\n$ python3 trace.py\n" +
                                     output_of("LD_LIBRARY_PATH='" + prefix() + "/lib' " + python + " '" +
                                               (examples / "trace.py").string() + "'") +
                                     "```\n"));
}

TEST_F(Embedded, header_is_c_and_the_library_shows_only_its_functions)
{
    EXPECT_EQ(output_of("printf '#include <tetrace/tetrace.h>\\nint main(void) { return 0; }\\n' > '" + prefix() +
                        "/main.c' && cc -std=c11 -Wall -Wextra -pedantic -Werror -fsyntax-only -I'" + prefix() +
                        "/include' '" + prefix() + "/main.c'"),
              "");
    const std::string header = read_text(prefix() + "/include/tetrace/tetrace.h");
    static const std::regex function("TETRACE_API [^;(]*?(tetrace_[a-z_]+)\\(");
    std::string declared;
    std::set<std::string> names;
    for (auto match = std::sregex_iterator(header.begin(), header.end(), function); match != std::sregex_iterator();
         ++match)
        names.insert((*match)[1]);
    for (const std::string& name : names)
        declared += name + "\n";
    EXPECT_EQ(output_of("nm -D --defined-only '" + prefix() +
                        "/lib/libtetrace.so' | cut -d' ' -f3 | cut -d@ -f1 | grep -v ^TETRACE | LC_ALL=C sort"),
              declared);
}
