// What every device backend builds on: launches, buffers, guard words, the self-test.
#include "backends/openmp/backend.h"
#include "core/error.h"
#include "core/launch.h"
#include "core/scene_buffers.h"
#include "core/self_test.h"
#include "core/ulps.h"
#include "scenes/procedural.h"

#include <bit>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <string>

using namespace tetrace;

namespace {

/// A session whose output is as the test wants it.
class FixedSession : public Session {
public:
    explicit FixedSession(std::function<void(std::span<std::uint32_t>)> fill) : fill_(std::move(fill)) {}
    void launch(const TraceJob&) override {}
    [[nodiscard]] double wait() override { return 0; }
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override { return 0; }

private:
    void read_output(std::span<std::uint32_t> words) override
    {
        std::fill(words.begin(), words.end(), POISON);
        fill_(words);
    }
    std::function<void(std::span<std::uint32_t>)> fill_;
};

std::string message_of(const std::function<void()>& work)
{
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// Results of a device that computes as the host does.
std::vector<std::uint32_t> right_results()
{
    return openmp_backend().probe(0, MathMode::exact, self_test_operations());
}

/// The results with those of one operation changed.
SelfTest judged_with(std::uint32_t operation, const std::function<std::uint32_t(const Row&, std::uint32_t)>& change)
{
    auto results = right_results();
    for (std::size_t i = 0; i < results.size(); i++)
        if (self_test_operations()[i].x == operation) results[i] = change(self_test_operations()[i], results[i]);
    return judge_self_test(results);
}

float number(std::uint32_t word)
{
    return std::bit_cast<float>(word);
}

} // namespace

TEST(session, gives_the_hits_between_the_guard_words)
{
    FixedSession session([](std::span<std::uint32_t> words) { words[GUARD_WORDS + HIT_WORDS + 1] = 77; });
    std::vector<Hit> hits(3);
    session.read_back(hits);
    EXPECT_EQ(hits[0].face_id, POISON);
    EXPECT_EQ(hits[1].tet, 77u);
}

TEST(session, names_the_side_on_which_a_kernel_wrote_outside_its_hits)
{
    std::vector<Hit> hits(3);
    FixedSession before([](std::span<std::uint32_t> words) { words[GUARD_WORDS - 1] = 0; });
    EXPECT_TRUE(contains(message_of([&] { before.read_back(hits); }), "before its hits"));
    FixedSession behind([](std::span<std::uint32_t> words) { words[GUARD_WORDS + 3 * HIT_WORDS] = 0; });
    EXPECT_TRUE(contains(message_of([&] { behind.read_back(hits); }), "behind its hits"));
}

TEST(launch_size, starts_small_grows_by_steps_and_shrinks_at_once)
{
    LaunchSize size(8);
    const std::uint32_t first = size.tiles();
    EXPECT_LE(first * 64, 16'384u);
    size.took(first, 1e-4);
    EXPECT_EQ(size.tiles(), 4 * first);
    size.took(4 * first, 10.0); // a hundred times the target
    EXPECT_NEAR(size.tiles(), 4 * first / 100.0, 1.0);
    size.took(1, 100.0);
    EXPECT_EQ(size.tiles(), 1u) << "a launch has a tile at least";
}

TEST(launch_size, a_steady_device_gets_a_tenth_of_a_second)
{
    LaunchSize size(4);
    constexpr double tiles_per_s = 1e5;
    for (int i = 0; i < 20; i++)
        size.took(size.tiles(), size.tiles() / tiles_per_s);
    EXPECT_NEAR(size.tiles() / tiles_per_s, 0.1, 0.01);
}

TEST(launch_size, the_short_last_launch_of_an_image_does_not_shrink_the_next)
{
    LaunchSize size(8);
    for (int i = 0; i < 20; i++)
        size.took(size.tiles(), size.tiles() * 1e-5);
    const std::uint32_t steady = size.tiles();
    size.took(3, 3e-5);
    EXPECT_GE(size.tiles(), steady * 9 / 10);
}

TEST(launch_params, carry_the_job_word_for_word)
{
    TraceJob job;
    job.view.step_y.z = 5;
    job.width = 17;
    job.height = 9;
    job.start_tet = 3;
    job.max_steps = 100;
    const LaunchParams params = launch_params(job, 6, 4, 20);
    EXPECT_EQ(params.step_y.z, 5);
    EXPECT_EQ(params.width, 17u);
    EXPECT_EQ(params.start_tet, 3u);
    EXPECT_EQ(params.divisions, 6u);
    EXPECT_EQ(params.tile_height, 4u);
    EXPECT_EQ(params.part_log2, 20u);
    EXPECT_EQ(tile_count(job, 4), 3u * 3u);
    EXPECT_EQ(output_words(job), 2 * GUARD_WORDS + HIT_WORDS * 17 * 9);
}

TEST(tet_parts, cut_the_tets_at_powers_of_two_and_lose_no_byte)
{
    const PackedScene packed = pack(make_cubes(8), Layout::tet80, TetOrder::hilbert);
    const auto tets = scene_buffers(packed)[0].bytes;
    ASSERT_GT(tets.size(), 200'000u);
    EXPECT_EQ(tet_parts(packed, 0).count, 1u);
    EXPECT_EQ(tet_parts(packed, tets.size()).count, 1u);
    const TetParts parts = tet_parts(packed, 100'000);
    EXPECT_EQ(parts.log2_bytes, 16u);
    ASSERT_EQ(parts.count, (tets.size() + 65'535) / 65'536);
    std::size_t sum = 0;
    for (unsigned i = 0; i < parts.count; i++) {
        EXPECT_EQ(parts.part(tets, i).data(), tets.data() + sum);
        sum += parts.part(tets, i).size();
    }
    EXPECT_EQ(sum, tets.size());
}

TEST(tet_parts, refuse_with_both_numbers)
{
    const PackedScene packed = pack(make_cubes(8), Layout::tet80, TetOrder::hilbert);
    const std::string too_many = message_of([&] { (void)tet_parts(packed, 20'000); });
    EXPECT_TRUE(contains(too_many, std::to_string(scene_buffers(packed)[0].bytes.size()))) << too_many;
    EXPECT_TRUE(contains(too_many, "20000"));
    EXPECT_TRUE(contains(message_of([&] { (void)tet_parts(packed, 1000); }), "'triangles'"));
}

TEST(self_test, the_host_is_exact)
{
    const SelfTest test = judge_self_test(right_results());
    EXPECT_EQ(test, SelfTest{});
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 0u);
}

TEST(self_test, finds_contraction)
{
    const auto fused = [](const Row& row, std::uint32_t) {
        return std::bit_cast<std::uint32_t>(std::fma(number(row.y), number(row.z), number(row.w)));
    };
    const SelfTest test = judged_with(PROBE_MULTIPLY_ADD, fused);
    EXPECT_TRUE(test.contracts);
    EXPECT_FALSE(test.is_exact());
    EXPECT_TRUE(contains(test.text(), "contracts"));
    EXPECT_TRUE(contains(test.brief(), "contracts"));
}

TEST(self_test, measures_division_and_decides_the_tolerance)
{
    const auto off = [](const Row&, std::uint32_t right) { return right + 2; };
    const SelfTest test = judged_with(PROBE_DIVIDE, off);
    EXPECT_EQ(test.division_ulps, 2u);
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 3u);
    EXPECT_EQ(judged_with(PROBE_SQUARE_ROOT, off).square_root_ulps, 2u);
}

TEST(self_test, finds_each_other_defect)
{
    const auto flushed = [](const Row&, std::uint32_t right) {
        return std::fpclassify(number(right)) == FP_SUBNORMAL ? right & 0x80000000u : right;
    };
    EXPECT_FALSE(judged_with(PROBE_MULTIPLY, flushed).denormals_kept);
    EXPECT_TRUE(judged_with(PROBE_MULTIPLY, flushed).is_exact()) << "no decision meets a denormal";
    EXPECT_FALSE(judged_with(PROBE_COPY, flushed).bits_kept);
    const auto off = [](const Row&, std::uint32_t right) { return right + 1; };
    EXPECT_FALSE(judged_with(PROBE_ADD, off).sums_right);
    EXPECT_FALSE(judged_with(PROBE_CONVERT, off).conversions_right);
    EXPECT_FALSE(judged_with(PROBE_COMPARE, off).comparisons_right);
    EXPECT_FALSE(judged_with(PROBE_INTEGER, off).integers_right);
}

TEST(self_test, the_hosts_fast_mode_contracts)
{
    if (const auto reason = openmp_backend().why_not(0, {.math = MathMode::fast}); !reason.empty())
        GTEST_SKIP() << reason;
    EXPECT_TRUE(judge_self_test(openmp_backend().probe(0, MathMode::fast, self_test_operations())).contracts);
}

TEST(yardstick, of_the_host_is_plausible)
{
    const auto yardstick = openmp_backend().yardstick(0, {.threads = 2});
    ASSERT_TRUE(yardstick.has_value());
    EXPECT_GT(yardstick->copy_bytes_per_s, 1e8);
    EXPECT_GT(yardstick->launch_s, 0);
}
