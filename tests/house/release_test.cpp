// What a release says of itself, and what scripts/release makes of the parts.
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <regex>

using namespace tetrace::test;

namespace {

const std::filesystem::path root = TETRACE_ROOT;

std::string version()
{
    const std::string text = read_text(root / "CMakeLists.txt");
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex("project\\(tetrace VERSION ([0-9.]+)")));
    return match[1];
}

} // namespace

TEST(Release, is_of_one_version_in_every_text)
{
    EXPECT_TRUE(contains(read_text(root / "CITATION.cff"), "\nversion: " + version() + "\n"));
    EXPECT_TRUE(read_text(root / "packages/changelog").starts_with("tetrace (" + version() + ")"));
    const std::string changes = read_text(root / "CHANGELOG.md");
    EXPECT_EQ(changes.find("\n## "), changes.find("\n## " + version())) << "the newest comes first";
}

TEST(Release, has_a_checksum_of_each_file_and_refuses_missing_parts)
{
    const TemporaryFolder folder;
    const auto run = [&] {
        return std::system(("cd '" + folder.path().string() + "' && '" + (root / "scripts/release").string() +
                            "' build small out > log 2>&1")
                               .c_str());
    };
    for (const char* const part : {"build/bundle/run-all", "build/tetrace_1_amd64.deb",
                                   "build/tetrace-builder_1_amd64.deb", "build/libtetrace-dev_1_amd64.deb"})
        write_file(folder / part, part);
    EXPECT_NE(run(), 0);
    EXPECT_TRUE(contains(read_text(folder / "log"), "tetrace-check-*.tar.xz is missing"));

    write_file(folder / "small/tetrace-check-1-linux-x.tar.xz", "small");
    // Not an image of these parts, whichever engine is here.
    const ScopedVariable path("PATH", "/usr/bin:/bin");
    for (const char* const engine : {"podman", "docker"})
        if (std::filesystem::exists(std::filesystem::path("/usr/bin") / engine))
            GTEST_SKIP() << engine << " would make an image";
    ASSERT_EQ(run(), 0) << read_text(folder / "log");
    EXPECT_TRUE(contains(read_text(folder / "log"), "without a container"));
    EXPECT_EQ(
        std::system(
            ("cd '" + (folder / "out").string() + "' && sha256sum --strict --check SHA256SUMS > ../log 2>&1").c_str()),
        0);
    const std::string sums = read_text(folder / "out/SHA256SUMS");
    EXPECT_EQ(std::ranges::count(sums, '\n'), 8);
    EXPECT_TRUE(contains(sums, "tetrace-bundle-" + version() + "-linux-"));
    write_file(folder / "out/CHANGELOG.md", "another");
    EXPECT_NE(
        std::system(("cd '" + (folder / "out").string() + "' && sha256sum --check SHA256SUMS > ../log 2>&1").c_str()),
        0);
}
