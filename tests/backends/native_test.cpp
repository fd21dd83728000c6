// Schedule native of openmp: other instructions, the same bits.
#include "core/device/given_quads.h"
#include "core/device/host.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Native : public testing::Test {
protected:
    void SetUp() override
    {
        if (!host_has_fused_multiply()) GTEST_SKIP() << "this processor does not run code for x86-64-v3";
    }

    static std::vector<Hit> hits_of(KernelId kernel, Schedule schedule, const PackedScene& packed, const RaySet& rays)
    {
        kernel.schedule = schedule;
        kernel.task = Task::rays;
        const auto session = openmp_backend().open(0, kernel, {nullptr, &packed}, {.threads = 2});
        session->set_rays(given_quads(rays, packed));
        return traced(*session, given_job(rays.rays.size(), packed.tet_count + 1, false));
    }
};

} // namespace

TEST_F(Native, kernels_hit_what_those_for_every_processor_hit)
{
    const Scene scene = make_cubes(7);
    for (const KernelId& kernel : all_kernels()) {
        if (kernel.schedule != Schedule::native || kernel.structure != Structure::cdt) continue;
        EXPECT_TRUE(openmp_backend().has_kernel(kernel)) << name_of(kernel);
        EXPECT_EQ(openmp_backend().why_not(0, kernel), "");
        const DeviceRays rays(scene, kernel.layout);
        KernelId tiles = kernel;
        tiles.schedule = Schedule::tiles;
        for (const TraceJob& job : jobs_of_all_kinds(rays)) {
            const auto right = traced(*openmp_backend().open(0, tiles, rays.data(), {.threads = 2}), job);
            const auto found = traced(*openmp_backend().open(0, kernel, rays.data(), {.threads = 2}), job);
            EXPECT_EQ(different_rays(found, right, 0), 0u) << name_of(kernel);
        }
        const RaySet hard = hard_ray_set(scene, 0, 4000);
        EXPECT_EQ(different_rays(hits_of(kernel, Schedule::native, rays.packed(), hard),
                                 hits_of(kernel, Schedule::tiles, rays.packed(), hard), 0),
                  0u)
            << name_of(kernel) << ", hard rays";
    }
}

TEST_F(Native, bvhs_hit_what_those_for_every_processor_hit)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const FullStacks stacks(layout);
        const KernelId kernel{.structure = Structure::bvh, .method = Method::single, .layout = layout};
        EXPECT_EQ(different_rays(hits_of(kernel, Schedule::native, stacks.packed, stacks.rays),
                                 hits_of(kernel, Schedule::tiles, stacks.packed, stacks.rays), 0),
                  0u)
            << name_of(kernel);
    }
}

TEST_F(Native, exists_only_in_openmp_and_exact_mode)
{
    KernelId kernel{.method = Method::project, .layout = Layout::half32, .schedule = Schedule::native};
    EXPECT_TRUE(openmp_backend().has_kernel(kernel));
    EXPECT_FALSE(is_common(kernel.schedule));
    kernel.math = MathMode::fast;
    EXPECT_FALSE(openmp_backend().has_kernel(kernel));
    kernel = {.method = Method::stp, .schedule = Schedule::native};
    EXPECT_FALSE(openmp_backend().has_kernel(kernel));
}
