// Method project has the same bits whether a walk carries the vertices of its face, on half32 and on tets that share
// their vertices, or loads them from tets that hold them: on every device, even if rays pass vertices and edges, and if
// a walk begins by following its path from the boundary.
#include "core/base/exact.h"
#include "core/device/backend.h"
#include "core/device/scene_buffers.h"
#include "core/mesh/locate.h"
#include "tests/support/cut_anew.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/half32.h"
namespace half32 {
#include "kernels/kernel_cpp.h"
}

/// The sign of the edge from p to q as if no two vertices were in line with the ray (docs/spec/project.md, P3): whether
/// it is positive.
bool is_left(half32::Sheared p, half32::Sheared q, bool p_is_first)
{
    if (p.x * q.y == p.y * q.x) return half32::is_left_at_tie(p, q, p_is_first, p.x * q.y);
    return p.x * q.y > p.y * q.x;
}

/// The places of a grid of 5 x 5 around the ray.
std::vector<half32::Sheared> places_round_the_ray()
{
    std::vector<half32::Sheared> places;
    for (int i = 0; i < 25; ++i)
        places.push_back({static_cast<float>(i % 5 - 2), static_cast<float>(i / 5 - 2)});
    return places;
}

/// The vertices of a tet as a ray sees them, those of a face first, in some order of them all. number: of that order.
struct SeenTet {
    std::array<half32::Sheared, 4> at;
    std::array<int, 4> number;

    [[nodiscard]] bool is_left_of(std::size_t i, std::size_t j) const
    {
        return is_left(at[i], at[j], number[i] < number[j]);
    }
    [[nodiscard]] bool is_entered() const { return is_left_of(0, 1) && is_left_of(1, 2) && is_left_of(2, 0); }
    [[nodiscard]] bool does_order_decide() const
    {
        for (std::size_t i = 0; i < 3; ++i)
            if (is_left(at[i], at[3], true) != is_left(at[i], at[3], false)) return true;
        return false;
    }
    /// The vertices of the face that the apex replaces, by all three signs: one bit each.
    [[nodiscard]] unsigned replaced() const
    {
        unsigned found = 0;
        for (std::size_t i = 0; i < 3; ++i)
            if (!is_left_of((i + 1) % 3, 3) && is_left_of((i + 2) % 3, 3)) found |= 1u << i;
        return found;
    }
};

constexpr Layout carrying_layouts[] = {Layout::half32, Layout::tet64, Layout::tet20, Layout::tet16};

/// `cubes` without its jitter: rays along the grid pass vertices, edges and faces.
Scene regular_cubes(std::uint32_t n)
{
    Scene scene = make_cubes(n);
    const auto at = [&](std::uint32_t i) {
        return snap_to_grid(2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f);
    };
    std::map<std::tuple<float, float, float>, Float3> moved;
    for (std::uint32_t i = 0; i < scene.tets.vertices.size(); ++i) {
        Float3& vertex = scene.tets.vertices[i];
        const Float3 place{at(i % (n + 1)), at(i / (n + 1) % (n + 1)), at(i / (n + 1) / (n + 1))};
        moved[{vertex.x, vertex.y, vertex.z}] = place;
        vertex = place;
    }
    for (Float3& vertex : scene.mesh.vertices)
        vertex = moved.at({vertex.x, vertex.y, vertex.z});
    for (auto& axis : scene.domain.lines)
        for (std::uint32_t i = 0; i <= n; ++i)
            axis[i] = at(i);
    return scene;
}

/// Directions on a grid of eighths, so that rays from a vertex pass others.
TraceJob job_from(Float3 origin, std::uint32_t max_steps)
{
    TraceJob job;
    job.view = {origin, {-1, -1, -1}, {0.125f, 0, 0.0625f}, {0, 0.125f, 0.0625f}};
    job.width = job.height = 17;
    job.max_steps = max_steps;
    return job;
}

/// What rays from each of the origins meet, those inside the domain from the tet that locate() names.
std::vector<Hit> hits_on(Backend& backend, std::size_t device, const Scene& scene, Layout layout,
                         const std::vector<Float3>& origins, std::uint32_t max_steps = 10'000,
                         std::uint64_t max_buffer_bytes = 0)
{
    const PackedScene packed = pack(scene, layout, TetOrder::chains);
    const KernelId kernel{.method = Method::project, .layout = layout};
    const SessionOptions options{.threads = 2, .max_buffer_bytes = max_buffer_bytes};
    const auto session = backend.open(device, kernel, {&scene.mesh, &packed}, options);
    std::vector<Hit> all;
    for (const Float3 origin : origins) {
        TraceJob job = job_from(origin, max_steps);
        start_in(job, packed, scene, locate(scene.tets, origin));
        const auto hits = traced(*session, job);
        all.insert(all.end(), hits.begin(), hits.end());
    }
    return all;
}

std::int64_t hits_of(const std::vector<Hit>& all)
{
    return std::count_if(all.begin(), all.end(), [](const Hit& hit) { return hit.face_id < POISON; });
}

std::int64_t lost_of(const std::vector<Hit>& all)
{
    return std::count_if(all.begin(), all.end(), [](const Hit& hit) { return hit.face_id == LOST; });
}

/// What rays meet that go through cluster_of() from so far that roundings leave a point of its inner cells, or a line:
/// along all diagonals of the space and of its planes. Only the order of the vertices decides the way through them.
std::vector<Hit> hits_on_cluster(const Scene& scene, Layout layout)
{
    const PackedScene packed = pack(scene, layout, TetOrder::chains);
    const auto session =
        openmp_backend().open(0, {.method = Method::project, .layout = layout}, {&scene.mesh, &packed}, {});
    std::vector<Hit> all;
    for (int i = 0; i < 27; ++i) {
        Float3 origin, direction;
        for (int axis = 0, digits = i; axis < 3; ++axis, digits /= 3) {
            direction[axis] = static_cast<float>(digits % 3 - 1);
            origin[axis] = 0.0625f + (direction[axis] == 0 ? 0x1p-23f : -4.0625f * direction[axis]);
        }
        TraceJob job;
        job.view = {origin, direction, {}, {}};
        job.width = job.height = 1;
        job.max_steps = 10'000;
        if (length(to_double(direction)) < 1.25) continue; // along an axis, or none
        const auto hits = traced(*session, job);
        all.insert(all.end(), hits.begin(), hits.end());
    }
    return all;
}

/// From a vertex, the middle of an edge and of a face, each in the tet that locate() names; and from outside.
std::vector<Float3> awkward_origins(const Scene& scene)
{
    std::vector<Float3> origins = {{0.25f, 0.5f, 3}, {-2, -2, -2}, {0, 0, 2}};
    for (const std::uint32_t index : {7u, 800u, 1500u, 2000u}) {
        const auto& vertices = scene.tets.tets[index].vertices;
        const Float3 a = scene.tets.vertices[vertices[0]], b = scene.tets.vertices[vertices[1]],
                     c = scene.tets.vertices[vertices[2]];
        origins.push_back(a);
        origins.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2});
        origins.push_back({(a.x + b.x) / 4 + c.x / 2, (a.y + b.y) / 4 + c.y / 2, (a.z + b.z) / 4 + c.z / 2});
    }
    return origins;
}

} // namespace

TEST(Carrying, has_the_bits_of_tet80_where_rays_pass_vertices_and_edges)
{
    const Scene scene = regular_cubes(8);
    ASSERT_EQ(find_defect(scene.tets, scene.mesh.triangles.size()), std::nullopt);
    const auto right = hits_on(openmp_backend(), 0, scene, Layout::tet80, awkward_origins(scene));
    EXPECT_GT(hits_of(right), 500);
    for (const Layout layout : carrying_layouts)
        EXPECT_EQ(different_rays(hits_on(openmp_backend(), 0, scene, layout, awkward_origins(scene)), right, 0), 0u)
            << name_of(layout);
}

TEST(Carrying, the_order_of_the_vertices_decides_no_exit)
{
    const auto places = places_round_the_ray();
    std::uint64_t entered = 0, ordered = 0, wrong = 0;
    SeenTet tet{{}, {0, 1, 2, 3}};
    do
        for (const auto& a : places)
            for (const auto& b : places)
                for (const auto& c : places) {
                    tet.at = {a, b, c, {}};
                    if (!tet.is_entered()) continue;
                    for (const auto& apex : places) {
                        tet.at[3] = apex;
                        ++entered;
                        ordered += tet.does_order_decide();
                        wrong += tet.replaced() != 1u << half32::replaced_by(a, b, c, apex);
                    }
                }
    while (std::ranges::next_permutation(tet.number).found);
    EXPECT_EQ(wrong, 0u) << "of " << entered;
    EXPECT_GT(ordered, 1000u);
}

TEST(Carrying, has_the_bits_of_tet80_where_tets_are_seen_as_lines_and_points)
{
    const Scene scene = cluster_of(0x1p-24f);
    ASSERT_EQ(find_defect(scene.tets, scene.mesh.triangles.size()), std::nullopt);
    const auto right = hits_on_cluster(scene, Layout::tet80);
    for (const Layout layout : carrying_layouts)
        EXPECT_EQ(different_rays(hits_on_cluster(scene, layout), right, 0), 0u) << name_of(layout);
}

TEST(Carrying, ends_at_the_cap_of_steps_where_tet80_does)
{
    const Scene scene = regular_cubes(8);
    for (const std::uint32_t cap : {1u, 2u, 5u}) {
        const auto right = hits_on(openmp_backend(), 0, scene, Layout::tet80, awkward_origins(scene), cap);
        EXPECT_GT(lost_of(right), 100);
        for (const Layout layout : carrying_layouts)
            EXPECT_EQ(
                different_rays(hits_on(openmp_backend(), 0, scene, layout, awkward_origins(scene), cap), right, 0), 0u);
    }
}

TEST(Carrying, has_the_same_bits_on_every_device)
{
    for (const Scene& scene : {regular_cubes(8), make_cubes(8)}) {
        const auto right = hits_on(openmp_backend(), 0, scene, Layout::tet80, awkward_origins(scene));
        for (Backend* backend : all_backends())
            for (std::size_t device = 0; device < backend->devices().size(); ++device)
                for (const Layout layout : carrying_layouts) {
                    if (!backend->devices()[device].usable || backend->name() == "embree") continue;
                    const auto hits = hits_on(*backend, device, scene, layout, awkward_origins(scene));
                    EXPECT_EQ(different_rays(hits, right, 3), 0u) << backend->name() << ' ' << name_of(layout);
                }
    }
}

TEST(Carrying, has_the_same_bits_with_the_tets_in_parts)
{
    Scene scene = make_cubes(8);
    scene.domain = cut_anew(scene.domain, 1); // the lists of boundary faces are not cut: shorter than a part
    const std::vector<Float3> origins = {{0.25f, 0.5f, 3}, {0.125f, 0.0625f, 0.03125f}};
    const auto right = hits_on(openmp_backend(), 0, scene, Layout::tet80, origins);
    for (const Layout layout : carrying_layouts) {
        const std::uint64_t limit = layout == Layout::half32 ? 100'000 : 40'000;
        ASSERT_GT(tet_parts(pack(scene, layout, TetOrder::chains), limit).count, 1u);
        for (Backend* backend : all_backends())
            for (std::size_t device = 0; device < backend->devices().size(); ++device) {
                const bool cuts_tets = backend->name() == "opencl" || backend->name() == "vulkan";
                if (!backend->devices()[device].usable || !cuts_tets) continue;
                const auto hits = hits_on(*backend, device, scene, layout, origins, 10'000, limit);
                EXPECT_EQ(different_rays(hits, right, 3), 0u) << backend->name() << ' ' << name_of(layout);
            }
    }
}
