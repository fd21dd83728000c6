// What a release says of itself, and what scripts/release makes of the parts.
#include "tests/house/checkout.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <regex>

using namespace tetrace::test;

namespace {

std::string version()
{
    const std::string text = read_text(checkout / "CMakeLists.txt");
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex("project\\(tetrace VERSION ([0-9.]+)")));
    return match[1];
}

} // namespace

TEST(Release, is_of_one_version_in_every_text)
{
    EXPECT_TRUE(contains(read_text(checkout / "CITATION.cff"), "\nversion: " + version() + "\n"));
    EXPECT_TRUE(read_text(checkout / "packages/changelog").starts_with("tetrace (" + version() + ")"));
    const std::string changes = read_text(checkout / "CHANGELOG.md");
    EXPECT_EQ(changes.find("\n## "), changes.find("\n## " + version())) << "the newest comes first";
}

TEST(Release, has_a_checksum_of_each_file_and_refuses_missing_parts)
{
    const TemporaryFolder folder;
    // Engines that cannot run: no image is made of these parts.
    for (const std::string engine : {"podman", "docker", "buildah"}) {
        write_file(folder / ("engines/" + engine), "#!/bin/sh\nexit 1\n");
        std::filesystem::permissions(folder / ("engines/" + engine), std::filesystem::perms::owner_all);
    }
    const ScopedVariable path("PATH", (folder / "engines").string() + ":" + std::getenv("PATH"));
    const auto run = [&](const std::string& command) {
        return std::system(("cd '" + folder.path().string() + "' && " + command + " > log 2>&1").c_str());
    };
    const std::string release = "'" + (checkout / "scripts/release").string() + "' build small out";
    for (const std::string part :
         {"bundle/run-all", "tetrace_V_amd64.deb", "tetrace-builder_V_amd64.deb", "libtetrace-dev_V_amd64.deb"})
        write_file(folder / ("build/" + std::regex_replace(part, std::regex("V"), version())), part);
    EXPECT_NE(run(release), 0);
    EXPECT_TRUE(contains(read_text(folder / "log"), "tetrace-check-" + version() + "-*.tar.gz is missing"));

    write_file(folder / ("small/tetrace-check-" + version() + "-linux-x.tar.gz"), "small");
    ASSERT_EQ(run(release), 0) << read_text(folder / "log");
    EXPECT_TRUE(contains(read_text(folder / "log"), "without a container"));
    EXPECT_EQ(run("cd out && sha256sum --strict --check SHA256SUMS"), 0);
    const std::string sums = read_text(folder / "out/SHA256SUMS");
    EXPECT_EQ(std::ranges::count(sums, '\n'), 8);
    EXPECT_TRUE(contains(sums, "tetrace-bundle-" + version() + "-linux-"));
    write_file(folder / "out/CHANGELOG.md", "another");
    EXPECT_NE(run("cd out && sha256sum --check SHA256SUMS"), 0);
}
