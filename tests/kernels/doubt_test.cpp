// Walks that ask early whether they go in circles: each walk's own source, compiled so that it asks after 3 steps.
#include "core/mesh/locate.h"
#include "core/pack/packed_scene.h"
#include "scenes/procedural.h"
#include "tests/support/device_rays.h"

#include <gtest/gtest.h>

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#undef STEPS_BEFORE_DOUBT
#define STEPS_BEFORE_DOUBT 3u

using namespace tetrace;
using namespace tetrace::test;

namespace {

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_METHOD_HEADER "kernels/methods/maria.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet80.h"
namespace maria_tet80 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
namespace project_tet80 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#define KERNEL_LAYOUT_HEADER "kernels/layouts/half32.h"
namespace project_half32 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet64.h"
namespace project_tet64 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_METHOD_HEADER
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_compact.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/compact_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet20.h"
namespace project_tet20 {
#include "kernels/kernel_cpp.h"
}

/// The hits of a job's rays, by the walk in a namespace.
#define HITS_OF(walk)                                                                                                  \
    [](const PackedScene& packed, const TraceJob& job) {                                                               \
        auto params = walk::params_of(job.view);                                                                       \
        params.start_tet = job.start_tet;                                                                              \
        params.max_steps = job.max_steps;                                                                              \
        params.start_v0 = job.start.vertices[0];                                                                       \
        params.start_v1 = job.start.vertices[1];                                                                       \
        params.start_v2 = job.start.vertices[2];                                                                       \
        params.start_v3 = job.start.vertices[3];                                                                       \
        params.start_neighbour = job.start.neighbour;                                                                  \
        std::vector<Hit> hits;                                                                                         \
        for (std::uint32_t i = 0; i < job.width * job.height; ++i) {                                                   \
            const auto hit =                                                                                           \
                walk::trace(walk::view_of(packed), params, walk::primary_ray(params, i % job.width, i / job.width));   \
            hits.push_back({hit.face_id, hit.tet, hit.t, hit.u, hit.v, hit.steps});                                    \
        }                                                                                                              \
        return hits;                                                                                                   \
    }

struct Walk {
    KernelId kernel;
    std::vector<Hit> (*hits_of)(const PackedScene& packed, const TraceJob& job);
};

const Walk walks[] = {{{.method = Method::maria, .layout = Layout::tet80}, HITS_OF(maria_tet80)},
                      {{.method = Method::project, .layout = Layout::tet80}, HITS_OF(project_tet80)},
                      {{.method = Method::project, .layout = Layout::half32}, HITS_OF(project_half32)},
                      {{.method = Method::project, .layout = Layout::tet64}, HITS_OF(project_tet64)},
                      {{.method = Method::project, .layout = Layout::tet20}, HITS_OF(project_tet20)}};

} // namespace

TEST(Doubt, changes_no_bit_of_a_walk_that_goes_in_no_circle)
{
    const Scene scene = make_cubes(8);
    for (const Walk& walk : walks) {
        const DeviceRays rays(scene, walk.kernel.layout);
        for (const TraceJob& job : jobs_of_all_kinds(rays)) {
            const auto session = openmp_backend().open(0, walk.kernel, rays.data(), {.threads = 2});
            const auto expected = traced(*session, job);
            EXPECT_EQ(different_rays(walk.hits_of(rays.packed(), job), expected, 0), 0u)
                << name_of(walk.kernel.method) << ' ' << name_of(walk.kernel.layout)
                << (job.start_tet == NO_TET ? ", from outside" : ", from inside");
        }
    }
}

TEST(Doubt, leaves_a_walk_lost_at_its_own_cap)
{
    const Scene scene = make_cubes(8);
    for (const Walk& walk : walks) {
        const DeviceRays rays(scene, walk.kernel.layout);
        for (const std::uint32_t cap : {2u, 3u, 4u, 9u}) {
            TraceJob job = rays.from_inside(33, 50);
            job.max_steps = cap;
            const auto session = openmp_backend().open(0, walk.kernel, rays.data(), {.threads = 2});
            EXPECT_EQ(different_rays(walk.hits_of(rays.packed(), job), traced(*session, job), 0), 0u)
                << name_of(walk.kernel.method) << ' ' << name_of(walk.kernel.layout) << ", cap " << cap;
        }
    }
}
