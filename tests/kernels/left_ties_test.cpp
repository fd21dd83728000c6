// Kernels that leave ties, each walk's own source: they leave the rays that meet one, and no hit of another ray
// changes.
#include "core/pack/packed_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#define DEFERS_TIES true

using namespace tetrace;
using namespace tetrace::test;

namespace {

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet80.h"
namespace leaves_tet80 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#define KERNEL_LAYOUT_HEADER "kernels/layouts/half32.h"
namespace leaves_half32 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet64.h"
namespace leaves_tet64 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_compact.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/compact_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet20.h"
namespace leaves_tet20 {
#include "kernels/kernel_cpp.h"
}

struct Count {
    std::size_t left = 0, left_at_entry = 0, differing = 0;
};

/// How many rays are left, and of how many others the hit is not that of the whole kernel.
/// trace: returns a pixel's hit, and whether its ray is left before its walk begins.
template <class Trace>
Count count_left(Layout layout, const TraceJob& job, const Scene& scene, const Trace& trace)
{
    const DeviceRays rays(scene, layout);
    const KernelId whole{.method = Method::project, .layout = layout};
    const auto hits = traced(*openmp_backend().open(0, whole, rays.data(), {.threads = 2}), job);
    Count count;
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        const auto [hit, is_left_at_entry] = trace(rays.packed(), job, i % job.width, i / job.width);
        count.left_at_entry += is_left_at_entry ? 1 : 0;
        if (hit.face_id == DEFERRED)
            ++count.left;
        else if (different_rays({hit}, {hits[i]}, 0) != 0)
            ++count.differing;
    }
    return count;
}

#define TRACE_OF(walk)                                                                                                 \
    [](const PackedScene& packed, const TraceJob& job, std::uint32_t x, std::uint32_t y) {                             \
        const auto view = walk::view_of(packed);                                                                       \
        const auto params = walk::params_of(job);                                                                      \
        const auto ray = walk::primary_ray(params, x, y);                                                              \
        return std::pair(std::bit_cast<Hit>(walk::trace(view, params, ray)),                                           \
                         walk::entrance_of(view, ray, walk::shear_of(ray)).index == DEFERRED);                         \
    }

void expect_left_at_ties_alone(Layout layout, const auto& trace)
{
    const auto lines = even_lines(8, 1);
    const Scene grid = grid_of({lines, lines, lines});
    const Count at_entry = count_left(layout, along_lines(17, 17, {0.25f, 0, 3}), grid, trace);
    EXPECT_GT(at_entry.left_at_entry, 17 * 17 / 10);
    EXPECT_LT(at_entry.left, 17 * 17);
    EXPECT_EQ(at_entry.differing, 0u);

    const Count in_walks = count_left(layout, between_lines(50, 41), grid, trace);
    EXPECT_EQ(in_walks.left_at_entry, 0u);
    EXPECT_GT(in_walks.left, 100u);
    EXPECT_LT(in_walks.left, 50 * 41);
    EXPECT_EQ(in_walks.differing, 0u);

    const Scene cubes = make_cubes(8);
    const Count few = count_left(layout, DeviceRays(cubes, layout).from_outside(61, 35), cubes, trace);
    EXPECT_LT(few.left, 3u);
    EXPECT_EQ(few.differing, 0u);
}

} // namespace

TEST(LeftTies, are_those_of_walks_that_read_corners_from_tets)
{
    expect_left_at_ties_alone(Layout::tet80, TRACE_OF(leaves_tet80));
}

TEST(LeftTies, are_those_of_walks_that_carry_vertices_through_records)
{
    expect_left_at_ties_alone(Layout::half32, TRACE_OF(leaves_half32));
    expect_left_at_ties_alone(Layout::tet64, TRACE_OF(leaves_tet64));
}

TEST(LeftTies, are_those_of_walks_through_compact_tets)
{
    expect_left_at_ties_alone(Layout::tet20, TRACE_OF(leaves_tet20));
}
