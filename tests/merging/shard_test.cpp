#include "bench/options/options.h"
#include "bench/options/shard.h"
#include "core/base/files.h"
#include "scenes/cache.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <numeric>
#include <unistd.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Words = std::vector<std::string>;

std::string refusal(const Words& words)
{
    return error_of([&] { static_cast<void>(parse_options(words)); });
}

} // namespace

TEST(Shard, parts_are_dealt_out_by_number_each_once)
{
    for (const unsigned of : {1u, 2u, 3u, 7u, 64u})
        for (const std::size_t parts : {0u, 1u, 5u, 64u, 1282u}) {
            std::vector<std::size_t> all(parts), seen;
            std::iota(all.begin(), all.end(), std::size_t{0});
            std::size_t most = 0, fewest = parts;
            for (unsigned number = 1; number <= of; ++number) {
                const auto own = dealt(all, Shard{number, of});
                seen.insert(seen.end(), own.begin(), own.end());
                most = std::max(most, own.size());
                fewest = std::min(fewest, own.size());
            }
            std::ranges::sort(seen);
            EXPECT_EQ(seen, all) << parts << " parts, " << of << " shards";
            EXPECT_LE(most - fewest, 1u);
        }
    EXPECT_EQ(dealt(Words{"a", "b", "c", "d", "e"}, Shard{2, 2}), (Words{"b", "d"}));
}

TEST(Shard, selects_among_the_views_that_were_asked_for)
{
    const Options options = parse_options({"bench", "--camera-set", "orbit", "--views", "10-20:2", "--shard", "2/3"});
    EXPECT_EQ(selected_views(options), (std::vector<std::uint32_t>{12, 18}));
}

TEST(Shard, a_shard_that_is_none_is_refused)
{
    for (const char* bad : {"0/4", "5/4", "4", "/4", "1/", "1/0", "a/b", "1/2/3", "-1/4", "1/65537"})
        EXPECT_TRUE(contains(refusal({"bench", "--shard", bad}), "--shard")) << bad;
    EXPECT_TRUE(contains(refusal({"check", "--shard", "5/5"}), "this shard would be empty; views selected: 4"));
    EXPECT_EQ(refusal({"check", "--shard", "4/4"}), "");
    EXPECT_TRUE(contains(refusal({"render", "--shard", "1/2"}), "--shard"))
        << "only runs that can be merged have shards";
}

TEST(Shard, shards_share_a_command_line_without_what_is_their_own)
{
    const Options options = parse_options({"reproduce", "table4", "--scene", "cubes", "--shard", "2/4", "--out=b.json",
                                           "--samples=3", "--resume", "--threads", "1", "--device=cpu"});
    EXPECT_EQ(options.arguments, (Words{"reproduce", "table4", "--scene", "cubes", "--samples=3"}));
    EXPECT_EQ(parse_options(options.arguments).arguments, options.arguments);
}

TEST(Shard, a_locked_file_cannot_be_locked_through_another_opening)
{
    const TemporaryFolder folder;
    write_file(folder / "file", "");
    const auto opened = [&] { return ::open((folder / "file").c_str(), O_RDWR | O_CLOEXEC); };
    const int first = opened(), second = opened();
    EXPECT_EQ(try_lock(first), LockAttempt::taken);
    EXPECT_EQ(try_lock(second), LockAttempt::held);
    ::close(first);
    EXPECT_EQ(try_lock(second), LockAttempt::taken) << "closing the file releases it";
    ::close(second);
}

TEST(Shard, whether_a_lock_is_held_can_be_seen_without_taking_it)
{
    const TemporaryFolder folder;
    EXPECT_FALSE(FileLock::is_held(folder / "lock"));
    {
        const auto lock = FileLock::try_take(folder / "lock");
        ASSERT_TRUE(lock);
        EXPECT_TRUE(FileLock::is_held(folder / "lock"));
    }
    EXPECT_FALSE(FileLock::is_held(folder / "lock"));
    EXPECT_FALSE(std::filesystem::exists(folder / "lock")) << "looking leaves no file";
}
