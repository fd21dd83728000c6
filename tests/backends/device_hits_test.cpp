// On every device of every API that can be used here: its hits are openmp's, whatever the layout, schedule, tile,
// image, camera and number of buffers.
#include "core/device/scene_buffers.h"
#include "tests/backends/each_device.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class DeviceHits : public EachDevice {
protected:
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
    void expect_hits(std::size_t device, const KernelId& kernel, const SceneData& data,
                     const std::vector<Expected>& all, const SessionOptions& options)
    {
        const auto session = open(device, kernel, data, options);
        for (const Expected& right : all)
            EXPECT_EQ(wrong_rays(device, traced(*session, right.job), right.hits), 0u)
                << backend.devices()[device].name << ' ' << name_of(kernel) << ' ' << name_of(kernel.schedule) << ' '
                << right.job.width << 'x' << right.job.height << " tile height " << options.tile_height
                << (right.job.start_tet == NO_TET ? " from outside" : " from inside");
    }
};

} // namespace

TEST_P(DeviceHits, find_openmps_hits_for_each_layout_schedule_and_tile)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        ASSERT_NE(rays.from_inside(8, 8).start_tet, NO_TET);
        ASSERT_EQ(rays.from_outside(8, 8).start_tet, NO_TET);
        const auto all = expected(rays, jobs_of_all_kinds(rays));
        for (const std::size_t device : usable)
            for (const Schedule schedule : schedules())
                for (const unsigned tile_height : {0u, 4u, 8u})
                    expect_hits(device, {.layout = layout, .schedule = schedule}, rays.data(), all,
                                {.threads = 2, .tile_height = tile_height});
    }
}

TEST_P(DeviceHits, find_openmps_hits_of_bvhs_for_each_schedule_and_tile)
{
    const Scene scene = make_cubes(8);
    const DeviceRays rays(scene, Layout::tet80);
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const PackedScene packed = make_bvh_scene(scene.mesh, layout);
        const SceneData data{&scene.mesh, &packed};
        KernelId kernel{.structure = Structure::bvh, .method = Method::single, .layout = layout};
        const auto on_host = openmp_backend().open(0, kernel, data, {.threads = 2});
        std::vector<Expected> all;
        for (const TraceJob& job : {rays.from_outside(61, 35), rays.from_outside(5, 90, 3), rays.from_outside(1, 1)})
            all.push_back({job, traced(*on_host, job)});
        for (const std::size_t device : usable)
            for (const Schedule schedule : schedules())
                for (const unsigned tile_height : {4u, 8u}) {
                    kernel.schedule = schedule;
                    expect_hits(device, kernel, data, all, {.threads = 2, .tile_height = tile_height});
                }
    }
}

TEST_P(DeviceHits, find_openmps_hits_with_the_tets_in_parts_or_refuse_to_cut_them)
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
                    expect_hits(device, {.layout = layout}, rays.data(), all, options);
                else
                    EXPECT_TRUE(error_of([&] {
                                    (void)open(device, {.layout = layout}, rays.data(), options);
                                }).starts_with("unsupported: "));
            }
        }
    }
}

TEST_P(DeviceHits, find_openmps_hits_for_an_image_of_many_launches)
{
    const DeviceRays rays(make_cubes(8), Layout::tet96);
    const auto all = expected(rays, {rays.from_outside(401, 390), rays.from_outside(401, 390, 0)});
    for (const std::size_t device : usable)
        for (const Schedule schedule : schedules())
            expect_hits(device, {.layout = Layout::tet96, .schedule = schedule}, rays.data(), all, {.threads = 1});
}

TEST_P(DeviceHits, find_the_same_faces_in_fast_mode_but_for_rays_on_edges)
{
    const KernelId kernel{.math = MathMode::fast};
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    const auto right = openmp_hits(rays, job);
    for (const std::size_t device : usable) {
        if (const auto reason = backend.why_not(device, kernel); !reason.empty()) GTEST_SKIP() << reason;
        const auto session = open(device, kernel, rays.data());
        EXPECT_LE(distant_rays(traced(*session, job), right), right.size() / 1000);
    }
}

INSTANTIATE_TEST_SUITE_P(each, DeviceHits, ::testing::ValuesIn(apis()), case_name);

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
