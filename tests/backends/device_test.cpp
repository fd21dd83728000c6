// On every device of every API that can be used here: its hits are openmp's, whatever the layout, schedule, tile,
// image, camera and number of buffers; its limits are told, its times are times. What one API alone has is in its own
// test.
#include "backends/cuda/driver_backend.h"
#include "core/base/stopwatch.h"
#include "core/device/scene_buffers.h"
#include "core/device/self_test.h"
#include "core/rays/search_set.h"
#include "tests/support/device_rays.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <map>
#include <ostream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Before the instance is made: what Vulkan's validation layers, where they are installed, have to say fails a case.
[[maybe_unused]] const int validation_is_on = ::setenv("TETRACE_VULKAN_VALIDATION", "1", 1);

/// An API, and what is claimed of it beyond what is claimed of all.
struct Api {
    std::string name;
    bool is_persistent = true; ///< it has kernels of schedule persistent
    bool cuts_tets = false;    ///< it binds tets that exceed a buffer in several; else its kernels address all memory
};
std::ostream& operator<<(std::ostream& out, const Api& api)
{
    return out << api.name;
}

/// All but the host's own, which the devices are compared with: the reference, and Embree, which runs no kernel of
/// ours.
std::vector<Api> apis()
{
    std::vector<Api> found = {{.name = "cuda-stub"}};
    for (const Backend* backend : all_backends())
        if (backend->name() != "embree" && backend != &reference_backend())
            found.push_back({.name = backend->name(),
                             .is_persistent = backend->name() != "vulkan",
                             .cuts_tets = backend->name() == "opencl" || backend->name() == "vulkan"});
    return found;
}

/// CUDA on the library that poses as NVIDIA's driver.
Backend& cuda_stub_backend()
{
    static cuda::DriverBackend backend(
        {"cuda-stub", "CUDA events", [] { return cuda::load_driver(TETRACE_STUB_CUDA); }, cuda::embedded_programs});
    return backend;
}

Backend& backend_of(const Api& api)
{
    const auto is_named = [&](const Backend* backend) { return backend->name() == api.name; };
    const auto found = std::ranges::find_if(all_backends(), is_named);
    return found != all_backends().end() ? **found : cuda_stub_backend();
}

/// The faces of one launch.
std::vector<std::uint32_t> searched(Session& session, const SearchRays& rays)
{
    session.set_rays(rays.quads);
    std::vector<std::uint32_t> faces(rays.count());
    EXPECT_GT(session.search(search_job(rays.count()), faces), 0);
    return faces;
}

std::size_t wrong_searches(const SearchRays& rays, const std::vector<std::uint32_t>& faces)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (judge(rays, i, faces[i]) != SearchVerdict::right) ++count;
    return count;
}

class Devices : public UsableDevices, public ::testing::WithParamInterface<Api> {
protected:
    Devices() : UsableDevices(backend_of(GetParam())) {}
    /// A job, and its hits on the host.
    struct Expected {
        TraceJob job;
        std::vector<Hit> hits;
    };

    [[nodiscard]] static std::vector<Schedule> schedules()
    {
        if (!GetParam().is_persistent) return {Schedule::tiles};
        return {Schedule::tiles, Schedule::persistent};
    }
    [[nodiscard]] static std::vector<Expected> expected(const DeviceRays& rays, const std::vector<TraceJob>& jobs)
    {
        std::vector<Expected> all;
        for (const TraceJob& job : jobs)
            all.push_back({job, openmp_hits(rays, job)});
        return all;
    }
    [[nodiscard]] SelfTest self_test(std::size_t device) const
    {
        return judge_self_test(backend.probe(device, MathMode::exact, self_test_operations()));
    }
    /// Rays of exact mode that are not openmp's, exactly or as near as the device's division lets them be.
    [[nodiscard]] std::size_t wrong_rays(std::size_t device, const std::vector<Hit>& hits,
                                         const std::vector<Hit>& openmps)
    {
        if (!allowed_ulps.contains(device)) allowed_ulps[device] = self_test(device).allowed_ulps();
        return different_rays(hits, openmps, allowed_ulps[device]);
    }
    void expect_hits(std::size_t device, const KernelId& kernel, const DeviceRays& rays,
                     const std::vector<Expected>& all, const SessionOptions& options)
    {
        const auto session = backend.open(device, kernel, rays.data(), options);
        for (const Expected& right : all)
            EXPECT_EQ(wrong_rays(device, traced(*session, right.job), right.hits), 0u)
                << backend.devices()[device].name << ' ' << name_of(kernel) << ' ' << name_of(kernel.schedule) << ' '
                << right.job.width << 'x' << right.job.height << " tile height " << options.tile_height
                << (right.job.start_tet == NO_TET ? " from outside" : " from inside");
    }

    std::map<std::size_t, std::uint64_t> allowed_ulps; ///< by device, once it was asked for
};

} // namespace

TEST_P(Devices, compute_exactly_in_exact_mode)
{
    for (const std::size_t device : usable)
        EXPECT_TRUE(self_test(device).is_exact()) << self_test(device).text();
}

TEST_P(Devices, find_openmps_hits_for_each_layout_schedule_and_tile)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        ASSERT_NE(rays.from_inside(8, 8).start_tet, NO_TET);
        ASSERT_EQ(rays.from_outside(8, 8).start_tet, NO_TET);
        const auto all = expected(rays, jobs_of_all_kinds(rays));
        for (const std::size_t device : usable)
            for (const Schedule schedule : schedules())
                for (const unsigned tile_height : {0u, 4u, 8u})
                    expect_hits(device, {.layout = layout, .schedule = schedule}, rays, all,
                                {.threads = 2, .tile_height = tile_height});
    }
}

TEST_P(Devices, find_openmps_hits_with_the_tets_in_parts_or_refuse_to_cut_them)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        const auto all = expected(rays, {rays.from_outside(39, 39), rays.from_inside(20, 20)});
        for (const std::uint64_t limit : {200'000, 130'000, 40'000}) {
            if (limit == 40'000 && layout == Layout::tet96) continue; // more parts than there may be
            ASSERT_GT(tet_parts(rays.packed(), limit).count, 1u);
            const SessionOptions options{.max_buffer_bytes = limit};
            for (const std::size_t device : usable) {
                if (GetParam().cuts_tets)
                    expect_hits(device, {.layout = layout}, rays, all, options);
                else
                    EXPECT_TRUE(error_of([&] {
                                    (void)backend.open(device, {.layout = layout}, rays.data(), options);
                                }).starts_with("unsupported: "));
            }
        }
    }
}

TEST_P(Devices, find_openmps_hits_for_an_image_of_many_launches)
{
    const DeviceRays rays(make_cubes(8), Layout::tet96);
    const auto all = expected(rays, {rays.from_outside(401, 390), rays.from_outside(401, 390, 0)});
    for (const std::size_t device : usable)
        for (const Schedule schedule : schedules())
            expect_hits(device, {.layout = Layout::tet96, .schedule = schedule}, rays, all, {.threads = 1});
}

TEST_P(Devices, give_the_same_hits_when_a_job_is_launched_twice)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        const auto first = traced(*session, rays.from_outside(50, 50));
        (void)traced(*session, rays.from_inside(20, 90));
        EXPECT_EQ(traced(*session, rays.from_outside(50, 50)), first);
    }
}

TEST_P(Devices, tell_what_a_session_took_and_holds)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        EXPECT_EQ(session->bytes(), rays.packed().bytes());
        EXPECT_GT(session->setup_times().compile_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
    }
}

TEST_P(Devices, tell_the_seconds_of_all_launches)
{
    constexpr int most_images = 40;
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const bool has_latency = backend.devices()[device].kind == DeviceKind::gpu; // longer than such an image takes
        const double wanted_share = has_latency ? 0 : 0.25; // the last of the three steps has a tenth of the tiles
        double largest_share = 0;
        for (int i = 0; i < most_images && largest_share <= wanted_share; ++i) {
            const auto session = backend.open(device, {}, rays.data(), {}); // its first image is launched in steps
            const Stopwatch watch;
            session->launch(rays.from_outside(300, 300));
            const double seconds = session->wait();
            const double wall_s = watch.seconds();
            EXPECT_LT(seconds, wall_s);
            largest_share = std::max(largest_share, seconds / wall_s);
        }
        EXPECT_GT(largest_share, wanted_share) << "a busy machine makes a share smaller, but not always";
    }
}

TEST_P(Devices, time_an_image_in_one_launch_too)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        for (const std::uint32_t size : {200u, 8u}) { // in steps that are waited for; one tile, in one launch
            session->launch(rays.from_outside(size, size));
            const double seconds = session->wait();
            EXPECT_GT(seconds, 0);
            EXPECT_LT(seconds, 60);
        }
    }
}

TEST_P(Devices, hold_sessions_side_by_side)
{
    const DeviceRays a(make_cubes(3), Layout::tet80), b(make_cubes(5), Layout::tet96);
    for (const std::size_t device : usable) {
        const auto first = backend.open(device, {.layout = Layout::tet80}, a.data(), {});
        const auto second = backend.open(device, {.layout = Layout::tet96}, b.data(), {});
        const TraceJob job_a = a.from_outside(30, 30), job_b = b.from_inside(40, 40);
        first->launch(job_a);
        second->launch(job_b);
        (void)second->wait();
        (void)first->wait();
        std::vector<Hit> hits_a(30 * 30), hits_b(40 * 40);
        first->read_back(hits_a);
        second->read_back(hits_b);
        EXPECT_EQ(wrong_rays(device, hits_a, openmp_hits(a, job_a)), 0u);
        EXPECT_EQ(wrong_rays(device, hits_b, openmp_hits(b, job_b)), 0u);
    }
}

TEST_P(Devices, are_not_harmed_by_a_launch_that_nobody_waits_for)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        session->launch(rays.from_outside(90, 90));
        EXPECT_EQ(wrong_rays(device, traced(*session, job), openmp_hits(rays, job)), 0u);
        session->launch(rays.from_outside(90, 90));
    }
}

TEST_P(Devices, give_whole_hits_before_anybody_waits)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(800, 800);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        (void)traced(*session, job); // the next one is not launched in steps that are waited for
        session->launch(job);
        std::vector<Hit> hits(std::size_t{job.width} * job.height);
        session->read_back(hits);
        EXPECT_EQ(wrong_rays(device, hits, openmp_hits(rays, job)), 0u);
        EXPECT_GT(session->wait(), 0) << "the launch's time is not lost";
    }
}

TEST_P(Devices, find_the_same_faces_in_fast_mode_but_for_rays_on_edges)
{
    const KernelId kernel{.math = MathMode::fast};
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    const auto right = openmp_hits(rays, job);
    for (const std::size_t device : usable) {
        if (const auto reason = backend.why_not(device, kernel); !reason.empty()) GTEST_SKIP() << reason;
        const auto session = backend.open(device, kernel, rays.data(), {});
        EXPECT_LE(distant_rays(traced(*session, job), right), right.size() / 1000);
    }
}

TEST_P(Devices, find_openmps_exits_for_each_method_and_layout)
{
    const auto first = search_rays(0, 30, 512), second = search_rays(30, 9, 200); // of another number
    for (const KernelId& kernel : kernels_of(Task::search)) {
        // The layouts are one piece of text for all methods: one method shows it, and compiling each takes a second.
        if (kernel.math != MathMode::exact || (kernel.layout == Layout::tet96 && kernel.method != Method::maria))
            continue;
        const PackedScene tets = search_tets(39, kernel.layout);
        const auto on_host = openmp_backend().open(0, kernel, {nullptr, &tets}, {.threads = 2});
        for (const std::size_t device : usable) {
            const auto session = backend.open(device, kernel, {nullptr, &tets}, {.threads = 2});
            for (const SearchRays* rays : {&first, &second, &first})
                EXPECT_EQ(searched(*session, *rays), searched(*on_host, *rays)) << name_of(kernel);
        }
    }
}

TEST_P(Devices, search_exits_of_the_rays_that_they_were_given_last)
{
    const KernelId kernel{.task = Task::search};
    const PackedScene tets = search_tets(2, kernel.layout);
    const auto first = search_rays(0, 1, 4096), second = search_rays(1, 1, 4096); // as many
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, kernel, {nullptr, &tets}, {});
        session->set_rays(first.quads);
        session->launch(search_job(first.count())); // nobody waits for it
        EXPECT_EQ(wrong_searches(second, searched(*session, second)), 0u);
        EXPECT_EQ(wrong_searches(first, searched(*session, first)), 0u);
    }
}

TEST_P(Devices, refuse_rays_that_exceed_a_buffer)
{
    const KernelId kernel{.task = Task::search};
    const PackedScene tets = search_tets(1, kernel.layout);
    const auto rays = search_rays(0, 1, 2048);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, kernel, {nullptr, &tets}, {.max_buffer_bytes = 50'000});
        const std::string problem = error_of([&] { session->set_rays(rays.quads); });
        EXPECT_TRUE(problem.starts_with("unsupported: ")) << problem;
        EXPECT_TRUE(contains(problem, "98304") && contains(problem, "50000; give fewer")) << problem;
    }
}

TEST_P(Devices, refuse_what_exceeds_a_limit_with_both_numbers)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob small = rays.from_outside(20, 10);
    const std::string bytes = std::to_string(scene_buffers(rays.packed())[0].bytes.size());
    for (const std::size_t device : usable) {
        const std::string scene =
            error_of([&] { (void)backend.open(device, {}, rays.data(), {.max_buffer_bytes = 20'000}); });
        EXPECT_TRUE(scene.starts_with("unsupported: ")) << scene;
        EXPECT_TRUE(contains(scene, bytes) && contains(scene, "20000"));
        const auto session = backend.open(device, {}, rays.data(), {.max_buffer_bytes = 300'000});
        const std::string image = error_of([&] { session->launch(rays.from_outside(200, 100)); });
        EXPECT_TRUE(image.starts_with("unsupported: ")) << image;
        EXPECT_TRUE(contains(image, "480512") && contains(image, "300000"));
        EXPECT_EQ(wrong_rays(device, traced(*session, small), openmp_hits(rays, small)), 0u) << "the session lives on";
    }
}

TEST_P(Devices, have_plausible_yardsticks)
{
    for (const std::size_t device : usable) {
        const auto yardstick = backend.yardstick(device, {});
        ASSERT_TRUE(yardstick.has_value());
        EXPECT_GT(yardstick->copy_bytes_per_s, 1e6);
        EXPECT_GT(yardstick->launch_s, 0);
    }
}

TEST_P(Devices, say_what_they_are)
{
    for (const std::size_t index : usable) {
        const Device& device = backend.devices()[index];
        EXPECT_FALSE(device.name.empty() || device.driver.empty() || device.id.empty());
        EXPECT_TRUE(device.kind == DeviceKind::gpu || device.kind == DeviceKind::emulated) << name_of(device.kind);
        EXPECT_NE(device.implementation.find('-'), std::string::npos) << device.implementation;
        EXPECT_GE(device.max_group_items, 64u);
        EXPECT_GT(device.memory_bytes, 0u);
        EXPECT_TRUE(device.uuid.empty() || device.uuid.size() == 32) << device.uuid;
        EXPECT_EQ(device.max_buffer_bytes != 0, GetParam().cuts_tets) << "0: memory is the limit";
    }
}

TEST_P(Devices, have_the_kernels_of_the_cdt_and_no_others)
{
    EXPECT_TRUE(backend.has_kernel({.layout = Layout::tet96, .math = MathMode::fast}));
    EXPECT_EQ(backend.has_kernel({.schedule = Schedule::persistent}), GetParam().is_persistent);
    EXPECT_TRUE(backend.has_kernel({.method = Method::ms06, .task = Task::search}));
    EXPECT_FALSE(backend.has_kernel({.schedule = Schedule::persistent, .task = Task::search}));
    EXPECT_FALSE(backend.has_kernel({.structure = Structure::bvh, .layout = Layout::embree}));
    EXPECT_FALSE(backend.has_kernel({.method = Method::single}));
    EXPECT_TRUE(contains(backend.why_not(0, {.method = Method::single}), "has no kernel"));
}

INSTANTIATE_TEST_SUITE_P(each, Devices, ::testing::ValuesIn(apis()), [](const auto& api) {
    std::string name = api.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(DeviceRaysTolerances, fail_for_wrong_answers)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    TraceJob shifted = job; // by a tenth of a pixel
    shifted.view.corner.x += 0.1F * job.view.step_x.x;
    shifted.view.corner.y += 0.1F * job.view.step_x.y;
    shifted.view.corner.z += 0.1F * job.view.step_x.z;
    const auto right = openmp_hits(rays, job), wrong = openmp_hits(rays, shifted);
    EXPECT_GT(distant_rays(wrong, right), right.size() / 1000);
    EXPECT_GT(different_rays(wrong, right, 3), right.size() / 10);
    auto nearly = right;
    const auto hit = std::find_if(nearly.begin(), nearly.end(), [](const Hit& h) { return h.t > 0; });
    ASSERT_NE(hit, nearly.end());
    for (int i = 0; i < 4; ++i)
        hit->t = std::nextafter(hit->t, 1e9F);
    EXPECT_EQ(different_rays(nearly, right, 3), 1u);
    EXPECT_EQ(different_rays(nearly, right, 4), 0u);
}
