#include "tests/house/checkout.h"
#include "tests/house/house.h"
#include "tests/support/temporary_folder.h"

#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

namespace fs = std::filesystem;

const House& house()
{
    static const House house(checkout / "tests/house/arrows.txt");
    return house;
}

const Sources& sources()
{
    static const Sources sources = read_sources(checkout);
    return sources;
}

std::string first_line(const fs::path& file)
{
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

/// The comment on a folder in the list of folders of a CMakeLists.txt: "name # comment".
std::string listed_sentence(const fs::path& list, const std::string& folder)
{
    std::ifstream stream(list);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string name, mark, sentence;
        if (words >> name >> mark && name == folder && mark == "#" && std::getline(words, sentence)) return sentence;
    }
    return {};
}

/// The sentence about a folder: the first line of its CMakeLists.txt, its line in that of a folder around it, or the
/// first line of its first header, which begins with the folder's name.
std::string sentence_of(const fs::path& folder)
{
    const std::string of_target = first_line(folder / "CMakeLists.txt");
    if (of_target.starts_with("# ")) return of_target;
    for (fs::path around = folder.parent_path(); around != checkout; around = around.parent_path())
        if (std::string listed = listed_sentence(around / "CMakeLists.txt", fs::relative(folder, around));
            !listed.empty())
            return listed;
    std::set<fs::path> headers;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".h") headers.insert(entry.path());
    const std::string of_header = headers.empty() ? std::string() : first_line(*headers.begin());
    return of_header.starts_with("// " + folder.filename().string() + "/: ") ? of_header : std::string();
}

} // namespace

TEST(House, has_an_arrow_for_every_include)
{
    EXPECT_EQ(joined(house().forbidden(sources().includes)), "");
    EXPECT_GT(sources().includes.size(), 1000u) << "the sources were read";
}

TEST(House, has_no_arrow_that_nothing_needs)
{
    EXPECT_EQ(joined(house().unused(sources().includes)), "");
}

TEST(House, has_no_circle)
{
    EXPECT_EQ(house().circle(), "");
}

/// For a reviewer, who sees whether a folder has several subjects.
TEST(House, prints_its_fullest_folders)
{
    std::vector<std::pair<int, std::string>> fullest;
    for (const auto& [folder, files] : sources().files)
        fullest.emplace_back(static_cast<int>(files), folder);
    std::ranges::sort(fullest, std::greater());
    ASSERT_GT(fullest.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i)
        std::printf("%d files in %s\n", fullest[i].first, fullest[i].second.c_str());
}

TEST(House, says_of_each_folder_what_belongs_there)
{
    for (const auto& [folder, files] : sources().files) {
        if (folder.starts_with("tests/")) continue;
        EXPECT_NE(sentence_of(checkout / folder), "") << folder;
    }
}

TEST(House, has_one_line_for_all_folders_of_a_kind)
{
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "arrows.txt") << "core/low ->\nbackends/* -> core/low\n";
    const test::House twin(folder.path() / "arrows.txt");
    const std::vector<test::Include> includes = {{"backends/one/a.h", "core/low/b.h"},
                                                 {"backends/one/part/a.h", "backends/one/a.h"},
                                                 {"backends/two/c.h", "backends/one/a.h"}};
    EXPECT_EQ(twin.listed_folder("backends/one/part/a.h"), "backends/one");
    EXPECT_EQ(joined(twin.forbidden(includes)), "backends/two/c.h includes backends/one/a.h: backends/two -> "
                                                "backends/one is not an allowed include (tests/house/arrows.txt)\n");
    EXPECT_EQ(joined(twin.unused(includes)), "");
}

TEST(House, finds_what_does_not_belong)
{
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "core/low/part");
    fs::create_directories(folder.path() / "core/high");
    std::ofstream(folder.path() / "core/low/part/a.h") << "#pragma once\n  #  include \"core/high/b.h\"\n";
    std::ofstream(folder.path() / "core/high/b.h") << "#include \"core/low/part/a.h\"\n#include \"other/c.h\"\n";
    std::ofstream(folder.path() / "arrows.txt") << "# comment\ncore/low ->\ncore/high -> core/low core/mid\n"
                                                << "core/mid -> core/high\n";
    const House twin(folder.path() / "arrows.txt");
    const auto includes = read_sources(folder.path()).includes;
    const std::string problems = joined(twin.forbidden(includes));
    EXPECT_NE(
        problems.find("core/low/part/a.h includes core/high/b.h: core/low -> core/high is not an allowed include"),
        std::string::npos);
    EXPECT_NE(problems.find("includes other/c.h"), std::string::npos);
    EXPECT_EQ(problems.find("core/high -> core/low "), std::string::npos);
    EXPECT_EQ(joined(twin.unused(includes)), "core/high -> core/mid\ncore/mid -> core/high\n");
    EXPECT_EQ(twin.circle(), "core/high");
}
