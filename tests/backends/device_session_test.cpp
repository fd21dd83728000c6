// On every device of every API that can be used here: sessions live side by side, their launches can be repeated, left
// alone and read before anybody waits, and their times are times.
#include "core/base/stopwatch.h"
#include "tests/backends/each_device.h"

#include <algorithm>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Devices : public EachDevice {};

} // namespace

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

TEST_P(Devices, give_the_same_hits_after_several_passes_in_either_schedule)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    TraceJob job = rays.from_outside(50, 50);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
            const KernelId kernel{.schedule = schedule};
            if (!backend.why_not(device, kernel).empty()) continue;
            const auto session = backend.open(device, kernel, rays.data(), {});
            for (const std::uint32_t passes : {1u, 5u, 2u}) { // the first image is launched in steps
                job.passes = passes;
                EXPECT_EQ(wrong_rays(device, traced(*session, job), openmp_hits(rays, job)), 0u) << passes;
            }
        }
}

// A pass that does nothing, for example because a counter of tiles is used up, leaves the hits of the first one.
TEST_P(Devices, take_longer_for_more_passes_in_either_schedule)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    TraceJob job = rays.from_outside(96, 96);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
            const KernelId kernel{.schedule = schedule};
            if (!backend.why_not(device, kernel).empty()) continue;
            const auto session = backend.open(device, kernel, rays.data(), {});
            (void)traced(*session, job); // the first image is launched in steps
            const auto seconds = [&](std::uint32_t passes) {
                job.passes = passes;
                session->launch(job);
                return session->wait();
            };
            double once = 1e9, often = 1e9; // the least of some: others may be at work, more than once
            for (int i = 0; i < 100 && (i < 5 || often <= 4 * once); ++i) {
                once = std::min(once, seconds(1));
                often = std::min(often, seconds(16));
            }
            EXPECT_GT(often, 4 * once) << name_of(schedule) << ": 16 times the work";
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

INSTANTIATE_TEST_SUITE_P(each, Devices, ::testing::ValuesIn(apis()), case_name);
