// The driver's own BVH: its hits are checked by the oracle; without one, a row has the reason.
#include "backends/vulkan/backend.h"
#include "backends/vulkan/session.h"
#include "bench/truth/oracle.h"
#include "core/device/given_quads.h"
#include "tests/backends/each_device.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Before the instance is made: in all builds, not only in debug ones.
constexpr std::array tracers = {vulkan::RayTracer::queries, vulkan::RayTracer::pipeline};

KernelId rt_kernel(vulkan::RayTracer tracer, Task task)
{
    return {.structure = Structure::bvh,
            .method = Method::single,
            .layout = Layout::rt,
            .math = MathMode::fast,
            .schedule = tracer == vulkan::RayTracer::pipeline ? Schedule::pipeline : Schedule::tiles,
            .task = task};
}

std::vector<std::string> extensions_of(vulkan::RayTracer tracer)
{
    const auto names = vulkan::ray_extensions(tracer);
    return {names.begin(), names.end()};
}

std::vector<Hit> answers(Session& session, const RaySet& set, const TriangleMesh& mesh)
{
    session.set_rays(given_quads_offset(set, mesh));
    return traced(session, given_job(set.rays.size(), 1, set.any_hit));
}

/// Runs a case's body on each device that has the tracer; visibly skipped where none has.
class VulkanRt : public ::testing::TestWithParam<vulkan::RayTracer> {
protected:
    void SetUp() override
    {
        std::string reasons;
        for (std::size_t i = 0; i < backend.devices().size(); ++i) {
            const std::string reason = backend.why_not(i, kernel(Task::trace));
            if (reason.empty()) able.push_back(i);
            reasons += reason;
        }
        if (able.empty()) GTEST_SKIP() << reasons;
    }
    static KernelId kernel(Task task) { return rt_kernel(GetParam(), task); }
    std::unique_ptr<Session> open(std::size_t device, const GivenScene& given, Task task,
                                  const SessionOptions& options = {})
    {
        return backend.open(device, kernel(task), {&given.scene.mesh, nullptr}, options);
    }

    Backend& backend = vulkan_backend();
    std::vector<std::size_t> able;
};

/// Those of rays that meet two triangles at an edge may differ.
std::size_t different_triangles(const std::vector<Hit>& some, const std::vector<Hit>& others)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < some.size(); ++i)
        count += some[i].face_id == others[i].face_id ? 0 : 1;
    return count;
}

/// What may be wrong: drivers promise that no ray slips between triangles, not which one an edge's ray meets, nor how
/// precise t, u and v are.
void expect_right(const Verdicts& verdicts, std::size_t rays, const std::string& what)
{
    EXPECT_EQ(verdicts.rays, rays);
    EXPECT_EQ(verdicts.lost, 0u) << what;
    EXPECT_LE(verdicts.wrong, rays / 1000)
        << what << ": " << (verdicts.first_wrong ? verdicts.first_wrong->reason : "none");
    EXPECT_GT(verdicts.agreed, rays * 95 / 100) << what;
}

} // namespace

TEST(RayTracers, are_had_where_no_extension_is_missing)
{
    using vulkan::RayTracer;
    const std::vector<std::string> queries = extensions_of(RayTracer::queries),
                                   pipeline = extensions_of(RayTracer::pipeline);
    std::vector<std::string> both = queries;
    both.emplace_back("VK_KHR_ray_tracing_pipeline");
    for (const bool is_emulated : {false, true}) {
        EXPECT_EQ(vulkan::why_no_tracer(RayTracer::queries, queries, is_emulated), "");
        EXPECT_EQ(vulkan::why_no_tracer(RayTracer::pipeline, pipeline, is_emulated), "");
        for (const RayTracer tracer : tracers)
            EXPECT_EQ(vulkan::why_no_tracer(tracer, both, is_emulated), "");
        EXPECT_EQ(vulkan::why_no_tracer(RayTracer::queries, pipeline, is_emulated),
                  "the driver lacks VK_KHR_ray_query; it has VK_KHR_ray_tracing_pipeline: take --schedule pipeline");
        EXPECT_EQ(vulkan::why_no_tracer(RayTracer::pipeline, queries, is_emulated),
                  "the driver lacks VK_KHR_ray_tracing_pipeline; it has VK_KHR_ray_query: take --schedule tiles");
    }
}

TEST(RayTracers, that_are_missing_have_a_reason_that_names_the_package)
{
    using vulkan::RayTracer;
    std::vector<std::string> neither = extensions_of(RayTracer::queries);
    std::erase(neither, "VK_KHR_ray_query");
    const std::string gpu = vulkan::why_no_tracer(RayTracer::queries, neither, false);
    EXPECT_TRUE(contains(gpu, "lacks VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline;") && contains(gpu, "GPU")) << gpu;
    EXPECT_TRUE(
        contains(vulkan::why_no_tracer(RayTracer::pipeline, neither, false), "lacks VK_KHR_ray_tracing_pipeline;"));
    const std::string emulated = vulkan::why_no_tracer(RayTracer::queries, {}, true);
    EXPECT_TRUE(contains(emulated, "VK_KHR_acceleration_structure, VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline, "))
        << emulated;
    EXPECT_TRUE(contains(emulated, "mesa-vulkan-drivers")) << "the package that has it: " << emulated;
    std::vector<std::string> partial = extensions_of(RayTracer::pipeline);
    std::erase(partial, "VK_KHR_deferred_host_operations");
    EXPECT_TRUE(contains(vulkan::why_no_tracer(RayTracer::pipeline, partial, false),
                         "lacks VK_KHR_deferred_host_operations; GPUs"));
}

TEST(RayTracers, have_kernels_in_every_build_and_a_device_without_them_refuses_with_its_reason)
{
    Backend& backend = vulkan_backend();
    const TriangleMesh mesh = make_cubes(2).mesh;
    for (const vulkan::RayTracer tracer : tracers)
        for (const Task task : {Task::trace, Task::rays}) {
            const KernelId kernel = rt_kernel(tracer, task);
            EXPECT_EQ(vulkan::tracer_of(kernel), tracer);
            EXPECT_TRUE(backend.has_kernel(kernel));
            for (std::size_t i = 0; i < backend.devices().size(); ++i) {
                const std::string reason = backend.why_not(i, kernel);
                if (reason.empty() || !backend.devices()[i].usable) continue;
                EXPECT_TRUE(contains(reason, "VK_KHR_")) << reason;
                const std::string refused = error_of([&] { (void)backend.open(i, kernel, {&mesh, nullptr}, {}); });
                EXPECT_EQ(refused, "unsupported: " + reason);
            }
        }
    KernelId other = rt_kernel(vulkan::RayTracer::queries, Task::search);
    EXPECT_FALSE(backend.has_kernel(other));
    other.task = Task::trace;
    other.schedule = Schedule::persistent;
    EXPECT_FALSE(backend.has_kernel(other));
    EXPECT_FALSE(backend.has_kernel({.schedule = Schedule::pipeline})) << "not one of tetrace's kernels";
}

TEST_P(VulkanRt, primary_hits_are_the_oracles_from_outside_and_inside)
{
    for (const std::size_t device : able)
        for (const bool inside : {false, true}) {
            const GivenScene given(61, inside); // no multiple of a tile
            const auto session = open(device, given, Task::trace);
            const auto hits = traced(*session, given.job);
            Oracle oracle(given.scene.mesh, 2);
            expect_right(oracle.judge(0, given.job.view, 61, 61, hits), hits.size(), "primary");
            EXPECT_EQ(traced(*session, given.job), hits) << "again the same";
        }
}

TEST_P(VulkanRt, given_rays_of_every_kind_are_answered_as_the_oracle_does)
{
    const GivenScene given(64, true);
    for (const std::size_t device : able) {
        const auto session = open(device, given, Task::rays);
        GivenOracle oracle(given.scene.mesh, 2);
        for (const RayKind kind : {RayKind::primary, RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random}) {
            const RaySet set = make_rays(kind, given.source());
            const auto hits = answers(*session, set, given.scene.mesh);
            expect_right(oracle.judge(set, hits, Origins::offset), hits.size(), std::string(name_of(kind)));
        }
    }
}

TEST_P(VulkanRt, rays_end_at_their_end_and_any_hit_says_whether_there_is_one)
{
    const GivenScene given(64, true);
    RaySet set = make_rays(RayKind::diffuse, given.source());
    for (const std::size_t device : able) {
        const auto session = open(device, given, Task::rays);
        const auto nearest = answers(*session, set, given.scene.mesh);
        const auto with_ends = [&](float factor, bool any_hit) {
            RaySet ended = set;
            ended.any_hit = any_hit;
            for (std::size_t i = 0; i < nearest.size(); ++i)
                if (nearest[i].face_id != NO_HIT) ended.rays[i].end = factor * nearest[i].t;
            return answers(*session, ended, given.scene.mesh);
        };
        const auto hits_of = [](const std::vector<Hit>& hits) {
            return std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.face_id != NO_HIT; });
        };
        EXPECT_GT(hits_of(nearest), 1000);
        EXPECT_EQ(hits_of(with_ends(0.9F, false)), 0) << "the end is before the nearest triangle";
        EXPECT_EQ(hits_of(with_ends(0.9F, true)), 0);
        EXPECT_EQ(with_ends(1.1F, false), nearest);
        EXPECT_EQ(hits_of(with_ends(1.1F, true)), hits_of(nearest));
    }
}

TEST_P(VulkanRt, sessions_tell_what_the_driver_built_and_how_long_it_took)
{
    const GivenScene small(8, false, 3), large(8, false, 9);
    for (const std::size_t device : able) {
        const auto session = open(device, large, Task::trace);
        EXPECT_GT(session->setup_times().build_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
        EXPECT_GT(session->bytes(), open(device, small, Task::trace)->bytes());
    }
}

TEST_P(VulkanRt, hits_are_the_same_where_the_host_does_not_see_the_devices_memory)
{
    const GivenScene given(32);
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.ray_tracing.why_not(GetParam()).empty()) continue;
        std::vector<std::vector<Hit>> hits;
        for (const bool stages : {false, true}) {
            found.always_stages = stages;
            vulkan::VulkanSession session(found, kernel(Task::trace), given.scene.mesh, {});
            hits.push_back(traced(session, given.job));
        }
        EXPECT_EQ(hits[1], hits[0]);
    }
}

TEST_P(VulkanRt, more_triangles_than_a_structure_holds_are_refused_with_both_numbers)
{
    const TriangleMesh mesh = make_cubes(3).mesh;
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.ray_tracing.why_not(GetParam()).empty()) continue;
        found.ray_tracing.max_triangles = 7;
        const std::string refused = error_of([&] { vulkan::VulkanSession(found, kernel(Task::trace), mesh, {}); });
        EXPECT_TRUE(refused.starts_with("unsupported: ")) << refused;
        EXPECT_TRUE(contains(refused, std::to_string(mesh.triangles.size())) && contains(refused, " 7")) << refused;
    }
}

TEST_P(VulkanRt, an_image_in_launches_of_few_rays_and_tiles_of_any_height_have_the_same_hits)
{
    const GivenScene given(61, false);
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.ray_tracing.why_not(GetParam()).empty()) continue;
        vulkan::VulkanSession whole(found, kernel(Task::trace), given.scene.mesh, {});
        const auto hits = traced(whole, given.job);
        found.limits.groups = 7;
        found.ray_tracing.max_rays = 5 * TILE_WIDTH * 8;
        for (const unsigned height : {4u, 8u}) {
            vulkan::VulkanSession cut(found, kernel(Task::trace), given.scene.mesh, {.tile_height = height});
            EXPECT_EQ(traced(cut, given.job), hits) << height;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(By, VulkanRt, ::testing::ValuesIn(tracers), [](const auto& tested) {
    return std::string(tested.param == vulkan::RayTracer::queries ? "ray_queries" : "a_pipeline");
});

TEST(RayTracers, meet_the_same_triangles_where_a_device_has_both)
{
    const GivenScene given(61, true);
    const RaySet set = make_rays(RayKind::diffuse, given.source());
    Backend& backend = vulkan_backend();
    std::size_t compared = 0;
    for (std::size_t i = 0; i < backend.devices().size(); ++i) {
        std::vector<std::vector<Hit>> images, answered;
        for (const vulkan::RayTracer tracer : tracers) {
            if (!backend.why_not(i, rt_kernel(tracer, Task::trace)).empty()) continue;
            const auto open = [&](Task task) {
                return backend.open(i, rt_kernel(tracer, task), {&given.scene.mesh, nullptr}, {});
            };
            images.push_back(traced(*open(Task::trace), given.job));
            answered.push_back(answers(*open(Task::rays), set, given.scene.mesh));
        }
        if (images.size() < tracers.size()) continue;
        EXPECT_LE(different_triangles(images[0], images[1]), images[0].size() / 1000);
        EXPECT_LE(different_triangles(answered[0], answered[1]), answered[0].size() / 1000);
        ++compared;
    }
    if (compared == 0) GTEST_SKIP() << "no device has both";
}
