// Rays through optimised tets: the triangles that they hit are those of the tets that the optimiser began with.
#include "backends/openmp/backend.h"
#include "bench/truth/oracle.h"
#include "core/mesh/locate.h"
#include "scenes/optimise/optimise.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

constexpr std::uint32_t size = 96;

std::vector<Hit> trace(const Scene& scene, const KernelId& kernel, const Camera& camera, Verdicts& verdicts)
{
    const PackedScene packed = pack(scene, kernel.layout, TetOrder::chains);
    TraceJob job;
    job.view = make_view(camera, size, size);
    const Start start = find_start(scene, job.view.origin);
    job.view.origin = start.origin;
    job.start_tet = start.tet == NO_TET ? NO_TET : packed.packed_of_mesh[start.tet];
    job.width = job.height = size;
    job.max_steps = packed.tet_count + 1;
    std::vector<Hit> hits(std::size_t{size} * size);
    const auto session = openmp_backend().open(0, kernel, {&scene.mesh, &packed}, {.threads = 2});
    (void)session->trace(job, hits);
    verdicts = Oracle(scene.mesh, 2).judge(0, job.view, size, size, hits);
    return hits;
}

std::uint64_t steps_of(const std::vector<Hit>& hits)
{
    std::uint64_t steps = 0;
    for (const Hit& hit : hits)
        steps += hit.steps;
    return steps;
}

} // namespace

TEST(RaysTets, give_the_same_hits_in_fewer_steps)
{
    const Scene plain = make_cubes(9);
    Scene optimised = plain;
    optimised.tets = optimise(plain.tets, {3, 0}, {}).mesh;
    for (const Method method : {Method::maria, Method::project}) {
        const KernelId kernel = {Structure::cdt, method, Layout::tet80, MathMode::exact};
        std::uint64_t steps_before = 0, steps_after = 0;
        for (const Camera& camera : make_cameras(CameraSet::smoke, bounding_sphere(plain.mesh))) {
            Verdicts before, after;
            const auto a = trace(plain, kernel, camera, before), b = trace(optimised, kernel, camera, after);
            EXPECT_TRUE(before.clean());
            EXPECT_TRUE(after.clean());
            std::uint64_t differ = 0;
            for (std::size_t i = 0; i < a.size(); ++i)
                differ += a[i].face_id != b[i].face_id ? 1 : 0;
            EXPECT_LE(differ, before.ties + after.ties + before.settled + after.settled) << "more than ties";
            steps_before += steps_of(a);
            steps_after += steps_of(b);
        }
        EXPECT_LT(steps_after, steps_before);
    }
}
