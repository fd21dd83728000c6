// What every device backend builds on: launches, buffers, guard words, the self-test.
#include "backends/openmp/backend.h"
#include "core/base/error.h"
#include "core/base/ulps.h"
#include "core/device/absent_backend.h"
#include "core/device/device_facts.h"
#include "core/device/launch.h"
#include "core/device/open_checks.h"
#include "core/device/scene_buffers.h"
#include "core/device/self_test.h"
#include "scenes/procedural.h"

#include <array>
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
SelfTest judged_with(std::uint32_t operation, const std::function<std::uint32_t(const Quad&, std::uint32_t)>& change)
{
    auto results = right_results();
    for (std::size_t i = 0; i < results.size(); ++i)
        if (self_test_operations()[i].x == operation) results[i] = change(self_test_operations()[i], results[i]);
    return judge_self_test(results);
}

LaunchParams params_of(std::uint32_t width, std::uint32_t height)
{
    TraceJob job;
    job.width = width;
    job.height = height;
    return launch_params(job, 8, 8, 31);
}

float number(std::uint32_t word)
{
    return std::bit_cast<float>(word);
}

} // namespace

TEST(Session, gives_the_hits_between_the_guard_words)
{
    FixedSession session([](std::span<std::uint32_t> words) { words[GUARD_WORDS + HIT_WORDS + 1] = 77; });
    std::vector<Hit> hits(3);
    session.read_back(hits);
    EXPECT_EQ(hits[0].face_id, POISON);
    EXPECT_EQ(hits[1].tet, 77u);
}

TEST(Session, names_the_side_on_which_a_kernel_wrote_outside_its_hits)
{
    std::vector<Hit> hits(3);
    FixedSession before([](std::span<std::uint32_t> words) { words[GUARD_WORDS - 1] = 0; });
    EXPECT_TRUE(contains(message_of([&] { before.read_back(hits); }), "before its output"));
    FixedSession behind([](std::span<std::uint32_t> words) { words[GUARD_WORDS + 3 * HIT_WORDS] = 0; });
    EXPECT_TRUE(contains(message_of([&] { behind.read_back(hits); }), "behind its output"));
}

TEST(LaunchSize, starts_small_grows_by_steps_and_shrinks_at_once)
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

TEST(LaunchSize, a_steady_device_gets_a_tenth_of_a_second)
{
    LaunchSize size(4);
    constexpr double tiles_per_s = 1e5;
    for (int i = 0; i < 20; ++i)
        size.took(size.tiles(), size.tiles() / tiles_per_s);
    EXPECT_NEAR(size.tiles() / tiles_per_s, 0.1, 0.01);
}

TEST(LaunchSize, the_short_last_launch_of_an_image_does_not_shrink_the_next)
{
    LaunchSize size(8);
    for (int i = 0; i < 20; ++i)
        size.took(size.tiles(), size.tiles() * 1e-5);
    const std::uint32_t steady = size.tiles();
    size.took(3, 3e-5);
    EXPECT_GE(size.tiles(), steady * 9 / 10);
}

TEST(LaunchSize, stays_within_the_apis_limit)
{
    LaunchSize size(8, 100);
    EXPECT_EQ(size.tiles(), 100u);
    size.took(100, 1e-6);
    EXPECT_EQ(size.tiles(), 100u);
}

TEST(Launches, cover_each_tile_of_an_image_once_and_in_order)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(300, 200);
    std::uint32_t next_tile = 0;
    const auto enqueue = [&](const LaunchParams& params, std::uint32_t tiles) {
        EXPECT_EQ(params.first_tile, next_tile);
        EXPECT_LE(tiles, 100u);
        next_tile += tiles;
        launches.took(tiles, 1e-3);
    };
    launches.start(image, enqueue, [] {});
    EXPECT_EQ(next_tile, tile_count(image));
}

TEST(Launches, ask_for_times_after_each_of_the_first_image_only)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(300, 200);
    for (const bool is_first : {true, false}) {
        int enqueued = 0, asked = 0;
        launches.start(
            image, [&](const LaunchParams&, std::uint32_t) { ++enqueued; }, [&] { ++asked; });
        EXPECT_GT(enqueued, 1);
        EXPECT_EQ(asked, is_first ? enqueued : 0);
    }
}

TEST(Launches, add_up_the_seconds_of_one_image)
{
    Launches launches(8, 100);
    const LaunchParams image = params_of(80, 80); // one launch
    for (const double seconds : {3.0, 0.5}) {
        launches.start(
            image, [](const LaunchParams&, std::uint32_t) {}, [] {});
        EXPECT_EQ(launches.seconds(), 0);
        launches.took(60, seconds);
        launches.took(40, 1.0);
        EXPECT_EQ(launches.seconds(), seconds + 1.0);
    }
}

TEST(Launches, are_sized_by_the_times_they_are_told)
{
    Launches launches(8);
    std::vector<std::uint32_t> sizes;
    launches.start(
        params_of(2000, 2000), [&](const LaunchParams&, std::uint32_t tiles) { sizes.push_back(tiles); },
        [&] { launches.took(sizes.back(), sizes.back() * 1e-3); }); // a tenth of a second: a hundred tiles
    ASSERT_GT(sizes.size(), 3u);
    EXPECT_NEAR(sizes[1], 100, 1);
    EXPECT_NEAR(sizes[2], 100, 1);
}

TEST(Output, is_refused_beyond_the_largest_buffer_with_both_numbers)
{
    EXPECT_NO_THROW(require_output_fits(250, 1000));
    EXPECT_NO_THROW(require_output_fits(1'000'000, 0));
    const std::string refused = message_of([] { require_output_fits(251, 1000); });
    EXPECT_TRUE(contains(refused, "1004") && contains(refused, "1000")) << refused;
    EXPECT_NO_THROW(require_output_of_last_launch(7, 7));
    EXPECT_TRUE(contains(message_of([] { require_output_of_last_launch(7, 9); }), "last launch has 9"));
}

TEST(LargestBuffer, is_the_smaller_of_the_devices_and_the_options)
{
    const auto largest = [](std::uint64_t of_device, std::uint64_t of_options) {
        Device device;
        device.max_buffer_bytes = of_device;
        return largest_buffer(device, {.max_buffer_bytes = of_options});
    };
    EXPECT_EQ(largest(0, 0), 0u);
    EXPECT_EQ(largest(100, 0), 100u);
    EXPECT_EQ(largest(0, 100), 100u);
    EXPECT_EQ(largest(100, 60), 60u);
    EXPECT_EQ(largest(60, 100), 60u);
}

TEST(PackedScene, is_checked_before_a_session_opens)
{
    const PackedScene packed = pack(make_cubes(3), Layout::tet80, TetOrder::hilbert);
    const Backend& host = openmp_backend();
    EXPECT_EQ(&packed_scene(host, 0, {}, {nullptr, &packed}), &packed);
    EXPECT_TRUE(contains(message_of([&] {
                             (void)packed_scene(host, 0, {.layout = Layout::tet96}, {nullptr, &packed});
                         }),
                         "not packed as tet96"));
    EXPECT_TRUE(contains(message_of([&] { (void)packed_scene(host, 0, {}, {}); }), "not packed as tet80"));
    EXPECT_TRUE(contains(message_of([&] {
                             (void)packed_scene(host, 0, {.method = Method::single}, {nullptr, &packed});
                         }),
                         "has no kernel"));
    const AbsentBackend absent("opencl", "the headers were missing");
    EXPECT_EQ(message_of([&] { (void)packed_scene(absent, 0, {}, {nullptr, &packed}); }), "the headers were missing");
}

TEST(DeviceFacts, are_written_as_the_system_writes_them)
{
    EXPECT_EQ(pci_address(0, 0x41, 0, 0), "0000:41:00.0");
    EXPECT_EQ(pci_address(1, 2, 0x1f, 7), "0001:02:1f.7");
    EXPECT_EQ(hexadecimal(std::array<std::uint8_t, 4>{0x00, 0x0f, 0xa0, 0xff}), "000fa0ff");
}

TEST(DeviceFacts, call_a_device_by_the_best_that_is_known_of_it)
{
    Device device;
    device.name = "name";
    EXPECT_EQ(id_of(device), "name");
    device.pci = "0000:41:00.0";
    EXPECT_EQ(id_of(device), device.pci);
    device.uuid = "00ff";
    EXPECT_EQ(id_of(device), device.uuid);
}

TEST(DeviceFacts, name_an_implementation_by_driver_and_version)
{
    EXPECT_EQ(implementation_name("Some (odd) Driver ", "v7.9.1-3 (LLVM 15)"), "some-odd-driver-7.9");
    EXPECT_EQ(implementation_name("driver", "7."), "driver-7");
    EXPECT_EQ(implementation_name("driver", "beta"), "driver");
    EXPECT_EQ(implementation_name("NVIDIA", "580.65.06"), "nvidia-580");
    EXPECT_EQ(implementation_name("", "1.2"), "unknown-1.2");
}

TEST(LaunchParams, carry_the_job_word_for_word)
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
    EXPECT_EQ(tile_count(params), 3u * 3u);
    EXPECT_EQ(output_words(job, Task::trace), 2 * GUARD_WORDS + HIT_WORDS * 17 * 9);
    EXPECT_EQ(output_words(job, Task::search), 2 * GUARD_WORDS + 17 * 9);
}

TEST(Searches, are_of_whole_quads_of_a_tile)
{
    EXPECT_EQ(search_job(24).width * search_job(24).height, 24u);
    EXPECT_EQ(search_job(24).width, TILE_WIDTH);
    EXPECT_TRUE(contains(message_of([] { (void)search_job(13); }), "13"));
    FixedSession session([](std::span<std::uint32_t>) {});
    EXPECT_TRUE(contains(message_of([&] { session.set_rays({}); }), "makes its own"));
}

TEST(Searches, find_faces_and_nothing_else)
{
    std::vector<std::uint32_t> faces(8);
    std::uint32_t written = NO_EXIT;
    std::size_t guard = GUARD_WORDS; // a word of the output that is no guard
    FixedSession session([&](std::span<std::uint32_t> words) {
        std::fill(words.begin() + GUARD_WORDS, words.end() - GUARD_WORDS, 2u);
        words[GUARD_WORDS + 5] = written;
        words[guard] = 2;
    });
    session.read_back(faces);
    EXPECT_EQ(faces, (std::vector<std::uint32_t>{2, 2, 2, 2, 2, NO_EXIT, 2, 2}));
    written = NO_EXIT + 1;
    EXPECT_TRUE(contains(message_of([&] { session.read_back(faces); }), "ray 5: face 5 was written"));
    written = POISON;
    EXPECT_TRUE(contains(message_of([&] { session.read_back(faces); }), "ray 5: no face was written"));
    guard = GUARD_WORDS - 1;
    EXPECT_TRUE(contains(message_of([&] { session.read_back(faces); }), "before its output"));
    guard = GUARD_WORDS + 8;
    EXPECT_TRUE(contains(message_of([&] { session.read_back(faces); }), "behind its output"));
}

TEST(TetParts, cut_the_tets_at_powers_of_two_and_lose_no_byte)
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
    for (unsigned i = 0; i < parts.count; ++i) {
        EXPECT_EQ(parts.part(tets, i).data(), tets.data() + sum);
        sum += parts.part(tets, i).size();
    }
    EXPECT_EQ(sum, tets.size());
}

TEST(TetParts, refuse_with_both_numbers)
{
    const PackedScene packed = pack(make_cubes(8), Layout::tet80, TetOrder::hilbert);
    const std::string too_many = message_of([&] { (void)tet_parts(packed, 20'000); });
    EXPECT_TRUE(contains(too_many, std::to_string(scene_buffers(packed)[0].bytes.size()))) << too_many;
    EXPECT_TRUE(contains(too_many, "20000"));
    EXPECT_TRUE(contains(message_of([&] { (void)tet_parts(packed, 1000); }), "'triangles'"));
}

TEST(SelfTest, the_host_is_exact)
{
    const SelfTest test = judge_self_test(right_results());
    EXPECT_EQ(test, SelfTest{});
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 0u);
}

TEST(SelfTest, finds_contraction)
{
    const auto fused = [](const Quad& quad, std::uint32_t) {
        return std::bit_cast<std::uint32_t>(std::fma(number(quad.y), number(quad.z), number(quad.w)));
    };
    const SelfTest test = judged_with(PROBE_MULTIPLY_ADD, fused);
    EXPECT_TRUE(test.contracts);
    EXPECT_FALSE(test.is_exact());
    EXPECT_TRUE(contains(test.text(), "contracts"));
    EXPECT_TRUE(contains(test.brief(), "contracts"));
}

TEST(SelfTest, measures_division_and_decides_the_tolerance)
{
    const auto off = [](const Quad&, std::uint32_t right) { return right + 2; };
    const SelfTest test = judged_with(PROBE_DIVIDE, off);
    EXPECT_EQ(test.division_ulps, 2u);
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 3u);
    EXPECT_EQ(judged_with(PROBE_SQUARE_ROOT, off).square_root_ulps, 2u);
}

TEST(SelfTest, finds_each_other_defect)
{
    const auto flushed = [](const Quad&, std::uint32_t right) {
        return std::fpclassify(number(right)) == FP_SUBNORMAL ? right & 0x80000000u : right;
    };
    EXPECT_FALSE(judged_with(PROBE_MULTIPLY, flushed).denormals_kept);
    EXPECT_TRUE(judged_with(PROBE_MULTIPLY, flushed).is_exact()) << "no decision meets a denormal";
    EXPECT_FALSE(judged_with(PROBE_COPY, flushed).bits_kept);
    const auto off = [](const Quad&, std::uint32_t right) { return right + 1; };
    EXPECT_FALSE(judged_with(PROBE_ADD, off).sums_right);
    EXPECT_FALSE(judged_with(PROBE_CONVERT, off).conversions_right);
    EXPECT_FALSE(judged_with(PROBE_COMPARE, off).comparisons_right);
    EXPECT_FALSE(judged_with(PROBE_INTEGER, off).integers_right);
}

TEST(SelfTest, the_hosts_fast_mode_contracts)
{
    if (const auto reason = openmp_backend().why_not(0, {.math = MathMode::fast}); !reason.empty())
        GTEST_SKIP() << reason;
    EXPECT_TRUE(judge_self_test(openmp_backend().probe(0, MathMode::fast, self_test_operations())).contracts);
}

TEST(Yardstick, of_the_host_is_plausible)
{
    const auto yardstick = openmp_backend().yardstick(0, {.threads = 2});
    ASSERT_TRUE(yardstick.has_value());
    EXPECT_GT(yardstick->copy_bytes_per_s, 1e8);
    EXPECT_GT(yardstick->launch_s, 0);
}
