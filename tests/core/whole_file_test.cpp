#include "core/base/files.h"

#include "tests/support/temporary_folder.h"

#include <csignal>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

/// While it lives, this process cannot write a file longer than that many bytes, as if the disk were full.
class ShortFiles {
public:
    explicit ShortFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit = {bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~ShortFiles()
    {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    ShortFiles(const ShortFiles&) = delete;
    ShortFiles& operator=(const ShortFiles&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int);
};

class WholeFile : public testing::Test {
protected:
    /// Why a text of a thousand bytes is not written where files may have a hundred.
    std::string refusal_of_a_long_text(const char* name) const
    {
        const ShortFiles limit(100);
        return error_of([&] { write_whole(folder_ / name, std::string(1000, 'x')); });
    }
    [[nodiscard]] std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_.path()), {}); }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(WholeFile, appears_with_all_its_bytes)
{
    const std::string text("a\0b\n", 4);
    write_whole(folder_ / "a", text);
    EXPECT_EQ(read_text(folder_ / "a"), text);
    write_whole(folder_ / "a", "");
    EXPECT_EQ(read_text(folder_ / "a"), "");
    EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, is_read_with_all_its_bytes_or_not_at_all)
{
    const std::string text("a\0b\n", 4);
    write_whole(folder_ / "a", text);
    EXPECT_EQ(file_bytes(folder_ / "a"), text);
    EXPECT_EQ(file_bytes(folder_ / "a", 3), text.substr(0, 3));
    EXPECT_EQ(file_bytes(folder_ / "none"), std::nullopt);
    EXPECT_EQ(file_bytes(folder_.path()), std::nullopt) << "it can be opened";
    EXPECT_EQ(file_bytes("/proc/self/mem"), std::nullopt) << "its first page cannot be read";
    EXPECT_FALSE(file_bytes("/proc/self/stat")->empty()) << "whose size is said to be 0";
}

TEST_F(WholeFile, does_not_appear_where_the_disk_is_full)
{
    const std::string error = refusal_of_a_long_text("a");
    EXPECT_TRUE(error.starts_with("invalid_input: ")) << error;
    EXPECT_TRUE(contains(error, (folder_ / "a").string())) << error;
    EXPECT_EQ(files(), 0) << "not even a temporary one";
}

TEST_F(WholeFile, leaves_the_file_before_it_where_the_disk_is_full)
{
    write_whole(folder_ / "a", "before");
    EXPECT_NE(refusal_of_a_long_text("a"), "");
    EXPECT_EQ(read_text(folder_ / "a"), "before");
    EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, keeps_links_and_permissions)
{
    write_whole(folder_ / "a", "before");
    fs::permissions(folder_ / "a", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("a", folder_ / "link");
    write_whole(folder_ / "link", "after");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_text(folder_ / "a"), "after");
    EXPECT_EQ(fs::status(folder_ / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(WholeFile, devices_are_written_to_and_not_replaced)
{
    fs::create_symlink("/dev/null", folder_ / "null");
    require_writable(folder_ / "null");
    write_whole(folder_ / "null", "text");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    fs::create_symlink("/dev/full", folder_ / "full");
    EXPECT_TRUE(contains(error_of([&] { write_whole(folder_ / "full", "text"); }), "No space left"));
}

TEST_F(WholeFile, is_known_to_be_impossible_before_any_work)
{
    EXPECT_TRUE(contains(error_of([&] { require_writable(folder_ / "nowhere/a"); }), "nowhere/a: "));
    EXPECT_TRUE(contains(error_of([&] { require_writable(folder_.path()); }), "Is a directory"));
    require_writable(folder_ / "a");
    EXPECT_EQ(files(), 0);
}
