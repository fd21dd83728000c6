// On every device of every API that can be used here: sessions live side by side, their launches can be repeated, left
// by itself and read before anybody waits, and their times are times.
#include "core/base/stopwatch.h"
#include "tests/backends/each_device.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <array>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class DeviceSessions : public EachDevice {};

} // namespace

TEST_P(DeviceSessions, give_the_same_hits_when_a_job_is_launched_twice)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        const auto first = traced(*session, rays.from_outside(50, 50));
        (void)traced(*session, rays.from_inside(20, 90));
        EXPECT_EQ(traced(*session, rays.from_outside(50, 50)), first);
    }
}

TEST_P(DeviceSessions, give_the_same_hits_after_several_passes_in_either_schedule)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    TraceJob job = rays.from_outside(50, 50);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
            const KernelId kernel{.schedule = schedule};
            if (!backend.why_not(device, kernel).empty()) continue;
            const auto session = open(device, kernel, rays.data());
            for (const std::uint32_t passes : {1u, 5u, 2u}) { // the first image is launched in steps
                job.passes = passes;
                EXPECT_EQ(wrong_rays(device, traced(*session, job), openmp_hits(rays, job)), 0u) << passes;
            }
        }
}

TEST_P(DeviceSessions, give_the_hits_of_single_launches_to_jobs_that_are_in_flight_together)
{
    for (const Layout layout : {Layout::tet80, Layout::half32}) {
        const DeviceRays rays(make_cubes(4), layout);
        const std::vector<TraceJob> all = jobs_of_all_kinds(rays); // of different sizes, from outside and inside
        for (const std::size_t device : usable)
            for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
                const KernelId kernel{.method = Method::project, .layout = layout, .schedule = schedule};
                if (!backend.why_not(device, kernel).empty()) continue;
                const auto session = open(device, kernel, rays.data());
                std::vector<Hit> single;
                for (const TraceJob& job : all)
                    for (const Hit& hit : traced(*session, job))
                        single.push_back(hit);
                for (const std::uint32_t passes : {1u, 3u, 1u}) {
                    std::vector<TraceJob> jobs = all;
                    for (TraceJob& job : jobs)
                        job.passes = passes;
                    EXPECT_EQ(traced(*session, jobs), single) << name_of(kernel) << ' ' << passes;
                }
                const std::vector<Hit> last = traced(*session, all.back());
                EXPECT_TRUE(std::equal(last.begin(), last.end(), single.end() - std::ssize(last))) << "again by itself";
            }
    }
}

TEST_P(DeviceSessions, give_joined_jobs_right_hits_in_a_sessions_first_launch_and_before_anybody_waits)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const std::vector jobs(5, rays.from_outside(300, 200)); // in several launches, which hold parts of two jobs
    const std::vector<Hit> right = openmp_hits(rays, jobs[0]);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        for (int time = 0; time < 2; ++time) {
            session->launch(jobs);
            std::vector<Hit> hits(jobs.size() * right.size());
            session->read_back(hits);
            for (std::size_t job = 0; job < jobs.size(); ++job) {
                const auto first = hits.begin() + static_cast<std::ptrdiff_t>(job * right.size());
                EXPECT_EQ(wrong_rays(device, {first, first + std::ssize(right)}, right), 0u) << job;
            }
            EXPECT_GT(session->wait(), 0);
            session->launch(jobs); // nobody waits for it
        }
    }
}

TEST_P(DeviceSessions, give_the_hits_of_single_launches_in_each_output_of_launches_in_flight)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    const std::vector<TraceJob> all = jobs_of_all_kinds(rays);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
            const KernelId kernel{.schedule = schedule};
            if (!backend.why_not(device, kernel).empty()) continue;
            const auto session = open(device, kernel, rays.data());
            const auto expect_right = [&](std::vector<TraceJob> jobs, std::uint32_t in_flight, std::uint32_t passes) {
                std::vector<Hit> single;
                for (TraceJob& job : jobs) {
                    for (const Hit& hit : openmp_hits(rays, job))
                        single.push_back(hit);
                    job.in_flight = in_flight;
                    job.passes = passes;
                }
                session->launch(jobs);
                EXPECT_GT(session->wait(), 0);
                const std::size_t outputs = std::min(in_flight, passes);
                std::vector<Hit> hits(outputs * single.size());
                session->read_back(hits);
                for (std::size_t output = 0; output < outputs; ++output) {
                    const auto first = hits.begin() + static_cast<std::ptrdiff_t>(output * single.size());
                    EXPECT_EQ(wrong_rays(device, {first, first + std::ssize(single)}, single), 0u)
                        << name_of(kernel) << ", output " << output << " of " << in_flight << ", passes " << passes;
                }
            };
            expect_right(all, 2, 3); // the first launch of the session
            expect_right(all, 2, 1);
            expect_right(all, 3, 7);
            expect_right(all, 8, 9);
            expect_right({all[2], all[4]}, 2, 600); // more passes than Vulkan has events for
            expect_right(all, 1, 2);
        }
}

TEST(HostSessions, refuse_launches_in_flight_together)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    TraceJob job = rays.from_outside(16, 16);
    job.in_flight = job.passes = 2;
    const auto session = reference_backend().open(0, {}, rays.data(), {});
    const std::string error = error_of([&] { session->launch(job); });
    EXPECT_TRUE(contains(error, "several launches in flight")) << error;
}

TEST_P(DeviceSessions, refuse_jobs_whose_hits_together_exceed_the_largest_buffer)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(64, 64);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data(), {.max_buffer_bytes = 250'000});
        const std::vector<Hit> hits = traced(*session, job);
        const std::string error = error_of([&] { session->launch(std::array{job, job, job}); });
        EXPECT_TRUE(contains(error, "250000") && contains(error, "fewer at once")) << error;
        EXPECT_EQ(traced(*session, job), hits) << "the session is alive";
    }
}

// A pass that does nothing, for example because a counter of tiles is used up, leaves the hits of the first one.
TEST_P(DeviceSessions, take_longer_for_more_passes_in_either_schedule)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    TraceJob job = rays.from_outside(96, 96);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent}) {
            const KernelId kernel{.schedule = schedule};
            if (!backend.why_not(device, kernel).empty()) continue;
            const auto session = open(device, kernel, rays.data());
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

TEST_P(DeviceSessions, give_whole_hits_before_anybody_waits)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(800, 800);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        (void)traced(*session, job); // the next one is not launched in steps that are waited for
        session->launch(job);
        std::vector<Hit> hits(std::size_t{job.width} * job.height);
        session->read_back(hits);
        EXPECT_EQ(wrong_rays(device, hits, openmp_hits(rays, job)), 0u);
        EXPECT_GT(session->wait(), 0) << "the launch's time is not lost";
    }
}

TEST_P(DeviceSessions, are_not_harmed_by_a_launch_that_nobody_waits_for)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        session->launch(rays.from_outside(90, 90));
        EXPECT_EQ(wrong_rays(device, traced(*session, job), openmp_hits(rays, job)), 0u);
        session->launch(rays.from_outside(90, 90));
    }
}

TEST_P(DeviceSessions, hold_sessions_side_by_side)
{
    const DeviceRays a(make_cubes(3), Layout::tet80), b(make_cubes(5), Layout::tet96);
    for (const std::size_t device : usable) {
        const auto first = open(device, {.layout = Layout::tet80}, a.data());
        const auto second = open(device, {.layout = Layout::tet96}, b.data());
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

TEST_P(DeviceSessions, tell_what_a_session_took_and_holds)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        EXPECT_EQ(session->bytes(), rays.packed().bytes());
        EXPECT_GT(session->setup_times().compile_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
    }
}

TEST_P(DeviceSessions, tell_the_seconds_of_all_launches)
{
    constexpr int max_images = 40;
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const bool has_latency = backend.devices()[device].kind == DeviceKind::gpu; // longer than such an image takes
        const double wanted_share = has_latency ? 0 : 0.25; // the last of the three steps has a tenth of the tiles
        double max_share = 0;
        for (int i = 0; i < max_images && max_share <= wanted_share; ++i) {
            const auto session = open(device, {}, rays.data()); // its first image is launched in steps
            const Stopwatch watch;
            session->launch(rays.from_outside(300, 300));
            const double seconds = session->wait();
            const double wall_s = watch.seconds();
            EXPECT_LT(seconds, wall_s);
            max_share = std::max(max_share, seconds / wall_s);
        }
        EXPECT_GT(max_share, wanted_share) << "a busy machine makes a share smaller, but not always";
    }
}

TEST_P(DeviceSessions, time_an_image_in_one_launch_too)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = open(device, {}, rays.data());
        for (const std::uint32_t size : {200u, 8u}) { // in steps that are waited for; one tile, in one launch
            session->launch(rays.from_outside(size, size));
            const double seconds = session->wait();
            EXPECT_GT(seconds, 0);
            EXPECT_LT(seconds, 60);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(each, DeviceSessions, ::testing::ValuesIn(apis()), case_name);
