// On every device of every API that can be used here: rays that are given are traced as those of an image, to BVHs and
// to tets, whatever was given before.
#include "core/base/error.h"
#include "core/device/given_quads.h"
#include "core/device/self_test.h"
#include "tests/backends/each_device.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_rays.h"

#include <algorithm>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Backend& backend_named(const std::string& name)
{
    return **std::ranges::find_if(all_backends(), [&](const Backend* backend) { return backend->name() == name; });
}

/// Of all backends that run kernels of ours.
std::vector<std::string> names()
{
    std::vector<std::string> names;
    for (const Backend* backend : all_backends())
        if (backend->name() != "embree") names.push_back(backend->name());
    return names;
}

class GivenRays : public UsableDevices, public ::testing::WithParamInterface<std::string> {
protected:
    GivenRays() : UsableDevices(backend_named(GetParam())) {}

    [[nodiscard]] std::vector<Schedule> schedules(KernelId kernel) const
    {
        kernel.schedule = Schedule::persistent;
        return backend.has_kernel(kernel) ? std::vector{Schedule::tiles, Schedule::persistent}
                                          : std::vector{Schedule::tiles};
    }
    std::vector<Hit> traced_given(Session& session, const RaySet& set, const std::vector<Quad>& quads) const
    {
        session.set_rays(quads);
        return traced(session, given_job(set.rays.size(), cubes.packed.tet_count + 1, set.any_hit));
    }
    std::uint32_t allowed_ulps(std::size_t device) const
    {
        return judge_self_test(backend.probe(device, MathMode::exact, self_test_operations())).allowed_ulps();
    }

    GivenScene cubes{40, false, 6};
};

} // namespace

TEST_P(GivenRays, of_kind_primary_are_those_that_kernels_make)
{
    const RaySet set = make_rays(RayKind::primary, cubes.source());
    ASSERT_EQ(set.rays.size(), cubes.hits.size());
    std::vector<Hit> by_ray(cubes.hits.size());
    for (std::size_t i = 0; i < by_ray.size(); ++i)
        by_ray[i] = cubes.hits[set.rays[i].pixel];
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {.task = Task::rays}, {&cubes.scene.mesh, &cubes.packed}, {});
        const auto hits = traced_given(*session, set, given_quads(set, cubes.packed));
        EXPECT_EQ(different_rays(hits, by_ray, allowed_ulps(device)), 0u) << backend.devices()[device].name;
    }
}

TEST_P(GivenRays, of_walks_that_ask_for_their_path_have_the_bits_of_openmp)
{
    RaySet hard = hard_ray_set(cubes.scene, 0, 3600);
    for (std::size_t i = 1; i < hard.rays.size(); i += 2)
        hard.rays[i].end = 0.375F;
    for (const Layout layout : {Layout::tet80, Layout::half32, Layout::tet64}) {
        const KernelId kernel{.method = Method::project, .layout = layout, .task = Task::rays};
        const PackedScene packed = pack(cubes.scene, layout, TetOrder::chains);
        for (const std::size_t device : usable) {
            const auto session = backend.open(device, kernel, {&cubes.scene.mesh, &packed}, {});
            for (const RaySet& set :
                 {hard, make_rays(RayKind::shadow, cubes.source()), make_rays(RayKind::diffuse, cubes.source())})
                EXPECT_EQ(different_rays(traced_given(*session, set, given_quads(set, packed)),
                                         cubes.answers(set, Method::project), allowed_ulps(device)),
                          0u)
                    << backend.devices()[device].name << ' ' << name_of(kernel);
        }
    }
}

TEST_P(GivenRays, are_those_of_each_of_launches_in_flight)
{
    const RaySet set = make_rays(RayKind::random, cubes.source());
    const std::vector<Hit> right = cubes.answers(set);
    for (const std::size_t device : usable) {
        if (backend.devices()[device].kind == DeviceKind::cpu) continue; // one at a time
        const auto session = backend.open(device, {.task = Task::rays}, {&cubes.scene.mesh, &cubes.packed}, {});
        session->set_rays(given_quads(set, cubes.packed));
        TraceJob job = given_job(set.rays.size(), cubes.packed.tet_count + 1, set.any_hit);
        job.in_flight = 2;
        job.passes = 4;
        session->launch(job);
        std::vector<Hit> hits(2 * right.size());
        session->read_back(hits);
        for (std::size_t output = 0; output < 2; ++output) {
            const auto first = hits.begin() + static_cast<std::ptrdiff_t>(output * right.size());
            EXPECT_EQ(different_rays({first, first + std::ssize(right)}, right, allowed_ulps(device)), 0u) << output;
        }
    }
}

TEST_P(GivenRays, are_those_that_were_given_last)
{
    const RaySet first = make_rays(RayKind::random, cubes.source(0)),
                 second = make_rays(RayKind::random, cubes.source(1));
    const RaySet fewer = make_rays(RayKind::diffuse, cubes.source(0));
    ASSERT_NE(first.rays.size(), fewer.rays.size());
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {.task = Task::rays}, {&cubes.scene.mesh, &cubes.packed}, {});
        for (const RaySet* set : {&first, &second, &fewer, &first})
            EXPECT_EQ(different_rays(traced_given(*session, *set, given_quads(*set, cubes.packed)), cubes.answers(*set),
                                     allowed_ulps(device)),
                      0u)
                << backend.devices()[device].name;
    }
}

TEST_P(GivenRays, of_bvhs_hit_what_openmp_hits_and_any_hit_is_a_hit)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const PackedScene packed = make_bvh_scene(cubes.scene.mesh, layout);
        const SceneData data{&cubes.scene.mesh, &packed};
        for (const RayKind kind : {RayKind::ao, RayKind::random}) {
            const RaySet set = make_rays(kind, cubes.source());
            const auto quads = given_quads_offset(set, cubes.scene.mesh);
            const KernelId kernel = bvh_kernel(layout, Task::rays);
            const auto on_host = openmp_backend().open(0, kernel, data, {.threads = 2});
            const auto right = traced_given(*on_host, set, quads);
            ASSERT_TRUE(std::ranges::any_of(right, [](const Hit& hit) { return hit.face_id < POISON; }));
            for (const std::size_t device : usable) {
                const std::uint32_t ulps = allowed_ulps(device);
                for (const Schedule schedule : schedules(kernel)) {
                    KernelId scheduled = kernel;
                    scheduled.schedule = schedule;
                    const auto session = backend.open(device, scheduled, data, {});
                    const auto hits = traced_given(*session, set, quads);
                    if (ulps == 0 || !set.any_hit) {
                        EXPECT_EQ(different_rays(hits, right, ulps), 0u)
                            << name_of(kernel) << ' ' << name_of(schedule) << ' ' << name_of(kind);
                    }
                    for (std::size_t i = 0; i < hits.size(); ++i)
                        ASSERT_EQ(hits[i].face_id < POISON, right[i].face_id < POISON) << name_of(kernel) << ' ' << i;
                }
            }
        }
    }
}

TEST_P(GivenRays, of_walks_hit_what_openmp_hits_in_each_schedule)
{
    const RaySet set = make_rays(RayKind::diffuse, cubes.source());
    for (const std::size_t device : usable)
        for (const Schedule schedule : schedules({.task = Task::rays})) {
            const auto session = backend.open(device, {.schedule = schedule, .task = Task::rays},
                                              {&cubes.scene.mesh, &cubes.packed}, {});
            EXPECT_EQ(different_rays(traced_given(*session, set, given_quads(set, cubes.packed)), cubes.answers(set),
                                     allowed_ulps(device)),
                      0u)
                << backend.devices()[device].name << ' ' << name_of(schedule);
        }
}

TEST_P(GivenRays, of_a_tree_that_fills_the_stack_hit_what_openmp_hits)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const FullStacks full(layout);
        const SceneData data{&full.mesh, &full.packed};
        const auto quads = given_quads_offset(full.rays, full.mesh);
        const auto on_host = openmp_backend().open(0, bvh_kernel(layout, Task::rays), data, {.threads = 2});
        const auto right = traced_given(*on_host, full.rays, quads);
        EXPECT_GT(std::ranges::count_if(right, [](const Hit& hit) { return hit.face_id < 20; }), 50)
            << "of the triangles that wait longest";
        for (const std::size_t device : usable) {
            const auto session = backend.open(device, bvh_kernel(layout, Task::rays), data, {});
            EXPECT_EQ(different_rays(traced_given(*session, full.rays, quads), right, allowed_ulps(device)), 0u)
                << backend.devices()[device].name << ' ' << name_of(layout);
        }
    }
}

TEST_P(GivenRays, of_bvhs_that_exceed_a_buffer_are_refused_with_both_numbers)
{
    const PackedScene packed = make_bvh_scene(cubes.scene.mesh, Layout::bvh2);
    const std::string bytes = std::to_string(packed.nodes.size() * sizeof(Quad));
    for (const std::size_t device : usable) {
        if (backend.name() == openmp_backend().name()) GTEST_SKIP() << "the host is not limited";
        std::string problem;
        try {
            (void)backend.open(device, bvh_kernel(Layout::bvh2, Task::trace), {&cubes.scene.mesh, &packed},
                               {.max_buffer_bytes = 1000});
        } catch (const Error& error) {
            problem = error.what();
            EXPECT_EQ(error.kind(), ErrorKind::unsupported);
        }
        EXPECT_NE(problem.find("'nodes'"), problem.npos) << problem;
        EXPECT_NE(problem.find(bytes), problem.npos) << problem;
        EXPECT_NE(problem.find("1000"), problem.npos) << problem;
    }
}

INSTANTIATE_TEST_SUITE_P(each, GivenRays, testing::ValuesIn(names()), [](const auto& test) {
    std::string name = test.param;
    std::ranges::replace(name, '-', '_');
    return name;
});
