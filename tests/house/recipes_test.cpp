// The recipes of docs/ARCHITECTURE.md: how many files one changes to add something. What core/device/PORTING.md, on how
// to add a backend, counts and names.
#include "tests/house/checkout.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

using namespace tetrace::test;

namespace {

struct Recipe {
    std::string what; ///< "A method"
    std::size_t files = 0, tests = 0;
    std::vector<std::string> listed; ///< the file that each numbered line begins with
};

std::vector<Recipe> read_recipes()
{
    static const std::regex heading(R"(\*\*(An? [a-z ]+): (\d+) files?(?:, and (?:(a) test|(\d+) (?:of )?tests))?.*)"),
        item(R"(\d+\. `([^`]+)`.*)");
    std::vector<Recipe> recipes;
    std::istringstream lines(read_text(checkout / "docs/ARCHITECTURE.md"));
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("#"))
            continue;
        else if (std::regex_match(line, match, heading))
            recipes.push_back({match[1],
                               std::stoul(match[2]),
                               match[3].matched   ? 1
                               : match[4].matched ? std::stoul(match[4])
                                                  : 0,
                               {}});
        else if (!recipes.empty() && std::regex_match(line, match, item))
            recipes.back().listed.push_back(match[1]);
    return recipes;
}

/// What the tree has of each kind, and where its files must name it.
const std::map<std::string, std::vector<std::string>> examples = {
    {"A method", {"maria", "plane", "plucker", "stp", "ms06", "project"}},
    {"A layout of tets", {"half32", "tet64", "tet20", "tet16"}},
    {"A task", {"segments", "tally", "absorb"}},
    {"A backend", {"openmp", "opencl", "vulkan", "cuda", "embree"}},
    {"A stressor", {"pairs_under_pressure", "zoo_of_exits", "lost_in_products"}},
    {"A column", {"spread", "mrays_per_s"}},
    {"A scene", {"cubes", "bunny", "armadillo"}},
    {"A procedural scene", {"atrium", "city", "terrain", "spheres", "grass", "plant"}},
    {"An option", {"samples", "budget"}}};

namespace fs = std::filesystem;
using Names = std::set<std::string>;

std::string porting()
{
    return read_text(checkout / "core/device/PORTING.md");
}

/// What the first group of a pattern matches, each time; the whole match if the pattern lacks groups.
std::vector<std::string> all_of(const std::string& text, const std::string& pattern)
{
    const std::regex regex(pattern);
    const std::sregex_token_iterator first(text.begin(), text.end(), regex, regex.mark_count() > 0 ? 1 : 0);
    return {first, {}};
}
Names names_in(const std::string& text, const std::string& pattern)
{
    const std::vector<std::string> all = all_of(text, pattern);
    return {all.begin(), all.end()};
}

/// The names of a class's virtual functions: those that a derived class must write, or those with a default.
Names virtuals_of(const std::string& name, bool must_be_written)
{
    const std::string header = read_text(checkout / "core/device/backend.h");
    const std::size_t begin = header.find("\nclass " + name + " {");
    Names names;
    for (const std::string& declared :
         all_of(header.substr(begin, header.find("\n};", begin) - begin), " virtual ([^~;{]+)"))
        if (declared.ends_with(" = 0") == must_be_written) names.merge(names_in(declared, "^[^(]*?(\\w+)\\("));
    return names;
}

/// The suites of the program <name>_tests; none if that program does not exist.
Names suites_of(const std::string& name)
{
    Names suites;
    for (const auto& entry : fs::recursive_directory_iterator(checkout / "tests"))
        if (entry.path().filename() == "CMakeLists.txt" &&
            std::regex_search(read_text(entry.path()), std::regex("\\btetrace_tests\\(" + name + "\\b")))
            for (const auto& source : fs::directory_iterator(entry.path().parent_path()))
                if (source.path().extension() == ".cpp")
                    suites.merge(names_in(read_text(source.path()), "\\nTEST(?:_[FP])?\\((\\w+),"));
    return suites;
}

/// A sentence for each file, program of tests and suite of a program that a page names, and that is not there.
std::vector<std::string> missing_in_tree(const std::string& page)
{
    std::vector<std::string> problems;
    for (const std::string& file : names_in(page, "\\b\\w+(?:/\\w+)+\\.\\w+"))
        if (!fs::is_regular_file(checkout / file)) problems.push_back("missing file: " + file);
    for (const std::string& program : names_in(page, "\\b(\\w+)_tests?\\b"))
        if (suites_of(program).empty()) problems.push_back("missing program: " + program + "_tests");
    const std::regex run("(\\w+)_tests --gtest_filter='([^']+)'");
    for (std::sregex_iterator match(page.begin(), page.end(), run), end; match != end; ++match) {
        const Names suites = suites_of(match->str(1));
        for (const std::string& filter : all_of(match->str(2), "(?:\\*/)?([^.:]+)(?:\\.[^:]*)?")) {
            const std::regex suite(std::regex_replace(filter, std::regex("\\*"), "\\w*"));
            if (std::ranges::none_of(suites, [&](const std::string& name) { return std::regex_match(name, suite); }))
                problems.push_back(match->str(1) + "_tests lacks suite " + filter);
        }
    }
    return problems;
}

} // namespace

TEST(Recipes, are_as_many_files_as_they_say_and_each_names_what_was_added_before)
{
    const auto recipes = read_recipes();
    EXPECT_EQ(recipes.size(), examples.size());
    for (const Recipe& recipe : recipes) {
        SCOPED_TRACE(recipe.what);
        ASSERT_TRUE(examples.contains(recipe.what));
        const auto tests = static_cast<std::size_t>(
            std::ranges::count_if(recipe.listed, [](const std::string& file) { return file.starts_with("tests/"); }));
        EXPECT_EQ(recipe.listed.size() - tests, recipe.files);
        EXPECT_EQ(tests, recipe.tests);
        for (const std::string& file : recipe.listed) {
            ASSERT_TRUE(std::filesystem::is_regular_file(checkout / file)) << file;
            const std::string text = read_text(checkout / file);
            for (const std::string& example : examples.at(recipe.what))
                EXPECT_TRUE(std::regex_search(text, std::regex("(^|[^a-z])" + example, std::regex::icase)))
                    << file << " lacks " << example;
        }
    }
}

TEST(Porting, counts_and_names_the_functions_of_the_contract)
{
    for (const std::string name : {"Backend", "Session"}) {
        SCOPED_TRACE(name);
        const std::string page = porting();
        const std::regex row("\n\\| `" + name + "` \\| (\\d+) to be written: ([^;\n]+); (\\d+) with defaults");
        std::smatch match;
        ASSERT_TRUE(std::regex_search(page, match, row));
        EXPECT_EQ(names_in(match[2], "`(\\w+)`"), virtuals_of(name, true));
        EXPECT_EQ(std::stoul(match[1]), virtuals_of(name, true).size());
        EXPECT_EQ(std::stoul(match[3]), virtuals_of(name, false).size());
    }
}

TEST(Porting, says_how_much_there_is_to_read_first)
{
    std::size_t lines = 0;
    for (const std::string& header : all_of(porting(), "\n\\| `([\\w/]+\\.h)` \\|"))
        lines += all_of(read_text(checkout / header), "\n").size();
    const auto limit = all_of(porting(), "fewer than (\\d+) lines");
    ASSERT_EQ(limit.size(), 1u);
    EXPECT_LT(lines, std::stoul(limit.front()));
    EXPECT_GT(lines + 100, std::stoul(limit.front()));
}

TEST(Porting, lists_the_macros_and_functions_of_every_dialect)
{
    std::optional<Names> macros;
    for (const auto& entry : fs::directory_iterator(checkout / "kernels/language"))
        if (entry.path().filename().string().starts_with("dialect_")) {
            const Names defined = names_in(read_text(entry.path()), "\n#define (\\w+)");
            if (!macros) macros = defined;
            std::erase_if(*macros, [&](const std::string& name) { return !defined.contains(name); });
        }
    const std::string page = porting();
    std::smatch match;
    ASSERT_TRUE(std::regex_search(
        page, match, std::regex("the macros ([^(]+)\\([^)]+\\), the\\s+types [^.]+ (\\d+)\\s+functions: ([^.]+)\\.")));
    EXPECT_EQ(names_in(match[1], "`(\\w+)`"), macros);
    const Names functions =
        names_in(read_text(checkout / "kernels/language/dialect_wgsl.h"), "\n\\w+ (\\w+)\\([^;{]+\\);");
    EXPECT_EQ(names_in(match[3], "`(\\w+)`"), functions);
    EXPECT_EQ(std::stoul(match[2]), functions.size());
}

TEST(Porting, names_files_programs_and_suites_that_exist)
{
    EXPECT_EQ(joined(missing_in_tree(porting())), "");
    EXPECT_EQ(joined(missing_in_tree("`core/device/gone.h`, `backends_tests --gtest_filter='Launch*:*/Gone.*'`, "
                                     "build/release/bin/device_test, `gone_tests`")),
              "missing file: core/device/gone.h\nmissing program: device_tests\nmissing program: gone_tests\n"
              "backends_tests lacks suite Gone\n");
}
