// What every device backend builds on: outputs between guard words, checks before a session opens, limits of buffers,
// names of devices. Launches and the self-test are in launches_test.cpp and self_test_test.cpp.
#include "backends/openmp/backend.h"
#include "core/device/absent_backend.h"
#include "core/device/device_facts.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"
#include "core/device/session.h"
#include "scenes/procedural.h"
#include "tests/support/cut_anew.h"
#include "tests/support/device_rays.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <functional>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A session whose output is as the test wants it.
class FixedSession : public Session {
public:
    explicit FixedSession(std::function<void(std::span<std::uint32_t>)> fill) : fill_(std::move(fill)) {}
    [[nodiscard]] double wait() override { return 0; }
    [[nodiscard]] SetupTimes setup_times() const override { return {}; }
    [[nodiscard]] std::uint64_t bytes() const override { return 0; }

private:
    void start(std::span<const TraceJob>) override {}
    void read_output(std::span<std::uint32_t> words) override
    {
        std::fill(words.begin(), words.end(), POISON);
        fill_(words);
    }
    std::function<void(std::span<std::uint32_t>)> fill_;
};

TraceJob job_of(std::uint32_t width, std::uint32_t height)
{
    TraceJob job;
    job.width = width;
    job.height = height;
    return job;
}

} // namespace

TEST(Session, gives_the_hits_between_the_guard_words)
{
    FixedSession session([](std::span<std::uint32_t> words) { words[GUARD_WORDS + HIT_WORDS + 1] = 77; });
    std::vector<Hit> hits(3);
    session.launch(job_of(3, 1));
    session.read_back(hits);
    EXPECT_EQ(hits[0].face_id, POISON);
    EXPECT_EQ(hits[1].tet, 77u);
}

TEST(Session, gives_the_hits_of_all_jobs_one_after_the_other)
{
    const std::array jobs = {job_of(7, 3), job_of(1, 1), job_of(40, 9)};
    FixedSession session([&](std::span<std::uint32_t> words) {
        std::uint32_t ray = 0;
        for (const std::size_t begin : {std::size_t{0}, OutputParts::alignment, 2 * OutputParts::alignment})
            for (std::size_t i = 0; i < jobs[begin / OutputParts::alignment].rays(); ++i)
                words[begin + GUARD_WORDS + HIT_WORDS * i] = ray++;
    });
    session.launch(jobs);
    std::vector<Hit> hits(7 * 3 + 1 + 40 * 9);
    session.read_back(hits);
    for (std::size_t i = 0; i < hits.size(); ++i)
        EXPECT_EQ(hits[i].face_id, i);
}

TEST(Session, names_the_side_on_which_a_kernel_wrote_outside_its_hits)
{
    const auto error_with = [](std::size_t jobs, std::size_t word) {
        FixedSession session([&](std::span<std::uint32_t> words) { words[word] = 0; });
        session.launch(std::vector(jobs, job_of(3, 1)));
        std::vector<Hit> hits(3 * jobs);
        return error_of([&] { session.read_back(hits); });
    };
    EXPECT_EQ(error_with(1, GUARD_WORDS + 3 * HIT_WORDS - 1), "");
    EXPECT_TRUE(contains(error_with(1, GUARD_WORDS - 1), "before its output"));
    EXPECT_TRUE(contains(error_with(1, GUARD_WORDS + 3 * HIT_WORDS), "after its output"));
    for (const std::size_t between : {GUARD_WORDS + 3 * HIT_WORDS, 500u, 1023u, 1024 + GUARD_WORDS - 1})
        EXPECT_TRUE(contains(error_with(2, between), "between the jobs of its output")) << between;
    EXPECT_EQ(error_with(2, 1024 + GUARD_WORDS), "");
    EXPECT_TRUE(contains(error_with(2, 1024 + GUARD_WORDS + 3 * HIT_WORDS), "after its output"));
}

TEST(HostSession, gives_the_hits_of_single_launches_to_jobs_that_are_launched_together)
{
    const Scene scene = make_cubes(3);
    int seen = 0;
    for (Backend* backend : all_backends())
        for (const KernelId& kernel : all_kernels()) {
            const bool is_on_host = backend->devices()[0].kind == DeviceKind::cpu && backend->has_kernel(kernel);
            if (!is_on_host || !backend->why_not(0, kernel).empty() || kernel.task != Task::trace) continue;
            const bool has_tets = is_portable(kernel) && kernel.structure == Structure::cdt;
            if (is_portable(kernel) && !has_tets) continue;
            const DeviceRays rays(scene, has_tets ? kernel.layout : Layout::tet80);
            const SceneData data{&scene.mesh, has_tets ? &rays.packed() : nullptr};
            const auto session = backend->open(0, kernel, data, {.threads = 2});
            std::vector<TraceJob> jobs = jobs_of_all_kinds(rays); // from outside and inside
            std::vector<Hit> single;
            for (const TraceJob& job : jobs)
                for (const Hit& hit : traced(*session, job))
                    single.push_back(hit);
            for (TraceJob& job : jobs)
                job.passes = 2;
            EXPECT_EQ(traced(*session, jobs), single) << backend->name() << ' ' << name_of(kernel);
            ++seen;
        }
    EXPECT_GT(seen, 5) << "schedules tiles, packets and native, and Embree";
}

TEST(Session, refuses_launches_of_no_job_or_of_different_passes_and_other_numbers_of_hits)
{
    FixedSession session([](std::span<std::uint32_t>) {});
    EXPECT_TRUE(contains(error_of([&] { session.launch(std::span<const TraceJob>()); }), "no job"));
    std::array jobs = {job_of(3, 1), job_of(3, 1)};
    jobs[1].passes = 2;
    EXPECT_TRUE(contains(error_of([&] { session.launch(jobs); }), "different passes"));
    jobs[0].passes = 2;
    session.launch(jobs);
    std::vector<Hit> hits(3);
    EXPECT_TRUE(contains(error_of([&] { session.read_back(hits); }), "3 results are asked for, the last launch has 6"));
}

TEST(Devices, have_texts_that_can_be_shown)
{
    struct Found {
        Device facts;
    };
    Device device;
    device.name = device.id = "GPU\x1b]0;title\x07\n2";
    device.driver = "caf\xe9";
    device.reason = "two\nlines\x1b[2J";
    const Device shown = facts_of(std::vector<Found>{{device}}).front();
    EXPECT_EQ(shown.name, "GPU?]0;title??2");
    EXPECT_EQ(shown.id, shown.name);
    EXPECT_EQ(shown.driver, "caf?");
    EXPECT_EQ(shown.reason, "two\nlines?[2J");
}

TEST(Output, is_refused_over_the_largest_buffer_with_both_numbers)
{
    EXPECT_NO_THROW(require_output_fits(250, 1000));
    EXPECT_NO_THROW(require_output_fits(1'000'000, 0));
    const std::string refused = error_of([] { require_output_fits(251, 1000); });
    EXPECT_TRUE(contains(refused, "1004") && contains(refused, "1000")) << refused;
    EXPECT_NO_THROW(require_output_of_last_launch(7, 7));
    EXPECT_TRUE(contains(error_of([] { require_output_of_last_launch(7, 9); }), "last launch has 9"));
}

TEST(LargestBuffer, is_the_smaller_of_the_devices_and_the_options)
{
    const auto largest = [](std::uint64_t of_device, std::uint64_t of_options) {
        Device device;
        device.max_buffer_bytes = of_device;
        return max_buffer(device, {.max_buffer_bytes = of_options});
    };
    EXPECT_EQ(largest(0, 0), 0u);
    EXPECT_EQ(largest(100, 0), 100u);
    EXPECT_EQ(largest(0, 100), 100u);
    EXPECT_EQ(largest(100, 60), 60u);
    EXPECT_EQ(largest(60, 100), 60u);
}

TEST(PackedScene, is_checked_before_a_session_opens)
{
    const PackedScene packed = pack(make_cubes(3), Layout::tet80, TetOrder::chains);
    const Backend& host = openmp_backend();
    EXPECT_EQ(&packed_scene(host, 0, {}, {nullptr, &packed}), &packed);
    EXPECT_TRUE(contains(error_of([&] {
                             (void)packed_scene(host, 0, {.layout = Layout::tet96}, {nullptr, &packed});
                         }),
                         "not packed as tet96"));
    EXPECT_TRUE(contains(error_of([&] { (void)packed_scene(host, 0, {}, {}); }), "not packed as tet80"));
    EXPECT_TRUE(contains(error_of([&] {
                             (void)packed_scene(host, 0, {.method = Method::single}, {nullptr, &packed});
                         }),
                         "lacks kernel"));
    const AbsentBackend absent("opencl", "the headers were missing");
    EXPECT_EQ(error_of([&] {
                  (void)packed_scene(absent, 0, {}, {nullptr, &packed});
              }),
              "missing: the headers were missing");
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
    EXPECT_EQ(implementation_name("nvidia-cuda", "580.65.06"), "nvidia-cuda-580");
    EXPECT_EQ(implementation_name("", "1.2"), "unknown-1.2");
}

TEST(Searches, are_of_whole_quads_of_a_tile)
{
    EXPECT_EQ(search_job(24).width * search_job(24).height, 24u);
    EXPECT_EQ(search_job(24).width, TILE_WIDTH);
    EXPECT_TRUE(contains(error_of([] { (void)search_job(13); }), "13"));
    FixedSession session([](std::span<std::uint32_t>) {});
    EXPECT_TRUE(contains(error_of([&] { session.set_rays({}); }), "makes its own"));
}

TEST(Searches, find_faces_and_nothing_else)
{
    std::vector<std::uint32_t> faces(8);
    std::uint32_t written = NO_EXIT;
    std::size_t guard = GUARD_WORDS; // a word of the output that is not a guard
    FixedSession session([&](std::span<std::uint32_t> words) {
        std::fill(words.begin() + GUARD_WORDS, words.end() - GUARD_WORDS, 2u);
        words[GUARD_WORDS + 5] = written;
        words[guard] = 2;
    });
    session.launch(search_job(8));
    session.read_back(faces);
    EXPECT_EQ(faces, (std::vector<std::uint32_t>{2, 2, 2, 2, 2, NO_EXIT, 2, 2}));
    written = NO_EXIT + 1;
    EXPECT_TRUE(contains(error_of([&] { session.read_back(faces); }), "ray 5: face 5 was written"));
    written = POISON;
    EXPECT_TRUE(contains(error_of([&] { session.read_back(faces); }), "ray 5: no face was written"));
    guard = GUARD_WORDS - 1;
    EXPECT_TRUE(contains(error_of([&] { session.read_back(faces); }), "before its output"));
    guard = GUARD_WORDS + 8;
    EXPECT_TRUE(contains(error_of([&] { session.read_back(faces); }), "after its output"));
}

TEST(TetParts, cut_the_tets_at_powers_of_two_and_lose_no_byte)
{
    const PackedScene packed = pack(make_cubes(8), Layout::tet80, TetOrder::chains);
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
    Scene scene = make_cubes(8);
    scene.domain = cut_anew(scene.domain, 1); // short lists of boundary faces: the tets are what is too many
    const PackedScene packed = pack(scene, Layout::tet80, TetOrder::chains);
    const std::string too_many = error_of([&] { (void)tet_parts(packed, 20'000); });
    EXPECT_TRUE(contains(too_many, std::to_string(scene_buffers(packed)[0].bytes.size()))) << too_many;
    EXPECT_TRUE(contains(too_many, "20000"));
    EXPECT_TRUE(contains(error_of([&] { (void)tet_parts(packed, 1000); }), "'triangles'"));
}

TEST(Yardstick, of_the_host_is_plausible)
{
    const auto yardstick = openmp_backend().yardstick(0, {.threads = 2});
    ASSERT_TRUE(yardstick.has_value());
    EXPECT_GT(yardstick->copy_bytes_per_s, 1e8);
    EXPECT_GT(yardstick->launch_s, 0);
}
