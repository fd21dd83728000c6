// The recipes of docs/ARCHITECTURE.md: how many files one changes to add something.
#include "tests/house/checkout.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <regex>

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
