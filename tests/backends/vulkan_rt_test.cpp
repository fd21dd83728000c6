// The driver's own BVH: where there is none the reason, else its answers by the oracle.
#include "backends/vulkan/backend.h"
#include "backends/vulkan/session.h"
#include "bench/truth/given_oracle.h"
#include "bench/truth/oracle.h"
#include "core/device/given_quads.h"
#include "tests/support/given_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Before the instance is made: in all builds, not only in debug ones.
[[maybe_unused]] const int validation_is_on = ::setenv("TETRACE_VULKAN_VALIDATION", "1", 1);

KernelId rt_kernel(Task task)
{
    return {.structure = Structure::bvh,
            .method = Method::single,
            .layout = Layout::rt,
            .math = MathMode::fast,
            .task = task};
}

std::vector<Hit> traced(Session& session, const TraceJob& job)
{
    std::vector<Hit> hits(std::size_t{job.width} * job.height);
    EXPECT_GT(session.trace(job, hits), 0);
    return hits;
}

std::vector<Hit> answers(Session& session, const RaySet& set, const TriangleMesh& mesh)
{
    session.set_rays(given_quads_offset(set, mesh));
    return traced(session, given_job(set.rays.size(), 1, set.any_hit));
}

/// Runs a case's body on each device that has ray queries; visibly skipped where none has.
class VulkanRt : public ::testing::Test {
protected:
    void SetUp() override
    {
        std::string reasons;
        for (std::size_t i = 0; i < backend.devices().size(); ++i) {
            const std::string reason = backend.why_not(i, rt_kernel(Task::trace));
            if (reason.empty()) able.push_back(i);
            reasons += reason;
        }
        if (able.empty()) GTEST_SKIP() << reasons;
    }
    std::unique_ptr<Session> open(std::size_t device, const GivenScene& given, Task task)
    {
        return backend.open(device, rt_kernel(task), {&given.scene.mesh, nullptr}, {});
    }

    Backend& backend = vulkan_backend();
    std::vector<std::size_t> able;
};

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

TEST(VulkanRayQueries, are_had_where_no_extension_is_missing_and_else_the_reason_names_what_is)
{
    std::vector<std::string> extensions(vulkan::ray_query_extensions.begin(), vulkan::ray_query_extensions.end());
    EXPECT_EQ(vulkan::why_no_ray_queries(extensions, false), "");
    std::erase(extensions, "VK_KHR_ray_query");
    const std::string gpu = vulkan::why_no_ray_queries(extensions, false);
    EXPECT_TRUE(contains(gpu, "lacks VK_KHR_ray_query;") && contains(gpu, "GPU")) << gpu;
    const std::string emulated = vulkan::why_no_ray_queries({}, true);
    EXPECT_TRUE(contains(emulated, "VK_KHR_acceleration_structure, VK_KHR_ray_query,")) << emulated;
    EXPECT_TRUE(contains(emulated, "mesa-vulkan-drivers")) << "what brings it: " << emulated;
}

TEST(VulkanRayQueries, every_build_has_the_kernels_and_a_device_without_them_refuses_with_its_reason)
{
    Backend& backend = vulkan_backend();
    const TriangleMesh mesh = make_cubes(2).mesh;
    for (const Task task : {Task::trace, Task::rays}) {
        const KernelId kernel = rt_kernel(task);
        EXPECT_TRUE(backend.has_kernel(kernel));
        for (std::size_t i = 0; i < backend.devices().size(); ++i) {
            const std::string reason = backend.why_not(i, kernel);
            if (reason.empty() || !backend.devices()[i].usable) continue;
            EXPECT_TRUE(contains(reason, "VK_KHR_")) << reason;
            const std::string refused = error_of([&] { (void)backend.open(i, kernel, {&mesh, nullptr}, {}); });
            EXPECT_EQ(refused, "unsupported: " + reason);
        }
    }
    EXPECT_FALSE(backend.has_kernel(rt_kernel(Task::search)));
}

TEST_F(VulkanRt, primary_hits_are_the_oracles_from_outside_and_inside)
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

TEST_F(VulkanRt, given_rays_of_every_kind_are_answered_as_the_oracle_does)
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

TEST_F(VulkanRt, rays_end_where_they_are_told_to_and_any_hit_tells_whether_there_is_one)
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

TEST_F(VulkanRt, sessions_tell_what_the_driver_built_and_how_long_it_took)
{
    const GivenScene small(8, false, 3), large(8, false, 9);
    for (const std::size_t device : able) {
        const auto session = open(device, large, Task::trace);
        EXPECT_GT(session->setup_times().build_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
        EXPECT_GT(session->bytes(), open(device, small, Task::trace)->bytes());
    }
}

TEST_F(VulkanRt, hits_are_the_same_where_the_host_does_not_see_the_devices_memory)
{
    const GivenScene given(32);
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.ray_queries.reason.empty()) continue;
        std::vector<std::vector<Hit>> hits;
        for (const bool stages : {false, true}) {
            found.always_stages = stages;
            vulkan::VulkanSession session(found, rt_kernel(Task::trace), given.scene.mesh, {});
            hits.push_back(traced(session, given.job));
        }
        EXPECT_EQ(hits[1], hits[0]);
    }
}

TEST_F(VulkanRt, more_triangles_than_a_structure_holds_are_refused_with_both_numbers)
{
    const TriangleMesh mesh = make_cubes(3).mesh;
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.ray_queries.reason.empty()) continue;
        found.ray_queries.most_triangles = 7;
        const std::string refused = error_of([&] { vulkan::VulkanSession(found, rt_kernel(Task::trace), mesh, {}); });
        EXPECT_TRUE(refused.starts_with("unsupported: ")) << refused;
        EXPECT_TRUE(contains(refused, std::to_string(mesh.triangles.size())) && contains(refused, " 7")) << refused;
    }
}
