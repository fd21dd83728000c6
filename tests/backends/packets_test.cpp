// Packets give the bits of the scalar kernel, at every width that this processor has.
#include "backends/openmp/packet_session.h"
#include "core/base/error.h"
#include "tests/support/damaged_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using openmp::packet_kernels;
using openmp::PacketKernel;

constexpr KernelId scalar{.method = tetrace::Method::project, .layout = tetrace::Layout::half32};
constexpr KernelId packets{
    .method = tetrace::Method::project, .layout = tetrace::Layout::half32, .schedule = tetrace::Schedule::packets};

std::vector<tetrace::Hit> scalar_hits(const DeviceRays& rays, const TraceJob& job)
{
    return traced(*tetrace::openmp_backend().open(0, scalar, rays.data(), {.threads = 2}), job);
}

std::vector<tetrace::Hit> packet_hits(PacketKernel kernel, const DeviceRays& rays, const TraceJob& job)
{
    tetrace::openmp::PacketSession session(kernel, tetrace::Task::trace, rays.packed(), 2);
    return traced(session, job);
}

std::ptrdiff_t count_of(const std::vector<tetrace::Hit>& hits, std::uint32_t face_id)
{
    return std::count_if(hits.begin(), hits.end(), [&](const tetrace::Hit& hit) { return hit.face_id == face_id; });
}

void expect_scalar_bits(const DeviceRays& rays, const TraceJob& job, const std::string& what)
{
    const auto expected = scalar_hits(rays, job);
    for (const PacketKernel& kernel : packet_kernels())
        EXPECT_EQ(different_rays(packet_hits(kernel, rays, job), expected, 0), 0u)
            << kernel.lanes << " lanes, " << job.width << " x " << job.height << ", " << what;
}

std::vector<tetrace::Hit> traced_given(tetrace::Session& session, const std::vector<tetrace::Quad>& quads,
                                       const TraceJob& job)
{
    session.set_rays(quads);
    return traced(session, job);
}

/// max_steps: 0 for as many as no walk takes.
void expect_scalar_bits_given(const tetrace::PackedScene& packed, const tetrace::RaySet& set, const std::string& what,
                              std::uint32_t max_steps = 0)
{
    const TraceJob job =
        tetrace::given_job(set.rays.size(), max_steps == 0 ? packed.tet_count + 1 : max_steps, set.any_hit);
    const auto quads = given_quads(set, packed);
    KernelId kernel = scalar;
    kernel.task = tetrace::Task::rays;
    const auto session = tetrace::openmp_backend().open(0, kernel, {nullptr, &packed}, {.threads = 2});
    const auto expected = traced_given(*session, quads, job);
    for (const PacketKernel& width : packet_kernels()) {
        tetrace::openmp::PacketSession tested(width, tetrace::Task::rays, packed, 2);
        EXPECT_EQ(different_rays(traced_given(tested, quads, job), expected, 0), 0u)
            << width.lanes << " lanes, " << set.rays.size() << " rays, " << what;
    }
}

/// On the lines of a regular grid: rays pass its vertices and edges, and more than one in ten meets a tie.
TraceJob along_lines(std::uint32_t width, std::uint32_t height, tetrace::Float3 origin)
{
    TraceJob job;
    job.view = {origin, {-1, -1, -2}, {0.125f, 0, 0}, {0, 0.125f, 0}};
    job.width = width;
    job.height = height;
    job.max_steps = 10'000;
    return job;
}

} // namespace

TEST(Packets, have_the_scalar_kernels_bits_from_outside_and_inside_whatever_the_images_size)
{
    const DeviceRays rays(tetrace::make_cubes(7), tetrace::Layout::half32);
    for (const TraceJob& job : jobs_of_all_kinds(rays))
        expect_scalar_bits(rays, job, job.start_tet == NO_TET ? "from outside" : "from inside");
}

TEST(Packets, have_the_scalar_kernels_bits_where_rays_pass_vertices_and_edges)
{
    const auto lines = even_lines(8, 1);
    const DeviceRays rays(grid_of({lines, lines, lines}), tetrace::Layout::half32);
    expect_scalar_bits(rays, along_lines(17, 17, {0.25f, 0, 3}), "along lines");
    expect_scalar_bits(rays, along_lines(17, 17, {0, 0, 4}), "on an axis");
    expect_scalar_bits(rays, along_lines(50, 41, {0.1f, 0.2f, 3}), "beside lines");
    expect_scalar_bits(rays, along_lines(23, 9, {3, 3, 3}), "along a diagonal");
}

TEST(Packets, of_views_along_each_axis_and_of_all_round_have_the_scalar_kernels_bits)
{
    // All deepest axes, both ways, and packets in which they change.
    const DeviceRays rays(tetrace::make_cubes(5), tetrace::Layout::half32);
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            tetrace::Float3 origin{}, corner{-1.5f, -1.5f, -1.5f}, step_x{}, step_y{};
            origin[axis] = -3 * sign;
            corner[axis] = sign;
            step_x[(axis + 1) % 3] = 3.0f / 53;
            step_y[(axis + 2) % 3] = 3.0f / 53;
            TraceJob job;
            job.view = {origin, corner, step_x, step_y};
            job.width = job.height = 54;
            job.max_steps = 10'000;
            expect_scalar_bits(rays, job, "along axis " + std::to_string(axis));
        }
}

TEST(Packets, of_given_rays_of_every_kind_have_the_scalar_kernels_bits)
{
    using tetrace::RayKind;
    for (const bool inside : {false, true}) {
        const GivenScene cubes(96, inside);
        const auto packed = pack(cubes.scene, tetrace::Layout::half32, tetrace::TetOrder::hilbert);
        for (const RayKind kind : {RayKind::primary, RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random}) {
            const tetrace::RaySet set = make_rays(kind, cubes.source());
            ASSERT_FALSE(set.rays.empty());
            expect_scalar_bits_given(packed, set, std::string(name_of(kind)) + (inside ? ", inside" : ", outside"));
        }
    }
}

TEST(Packets, of_given_rays_that_pass_vertices_and_edges_have_the_scalar_kernels_bits)
{
    for (const auto& [name, scene] : make_hard_scenes()) {
        const auto packed = pack(scene, tetrace::Layout::half32, tetrace::TetOrder::hilbert);
        tetrace::RaySet set = hard_ray_set(scene, 0, 9 * 2048);
        expect_scalar_bits_given(packed, set, name);
        for (std::size_t i = 1; i < set.rays.size(); i += 2)
            set.rays[i].end = 0.375f;
        expect_scalar_bits_given(packed, set, std::string(name) + ", some with ends");
    }
}

TEST(Packets, of_given_rays_have_the_scalar_kernels_bits_however_many_they_are)
{
    const tetrace::Scene scene = tetrace::make_cubes(5);
    const auto packed = pack(scene, tetrace::Layout::half32, tetrace::TetOrder::hilbert);
    for (const std::size_t count : {8u, 24u, 40u, 504u, 512u, 520u, 16'400u})
        expect_scalar_bits_given(packed, hard_ray_set(scene, 7, count), "two threads that take 512 at once");
}

TEST(Packets, of_given_rays_lose_those_that_the_scalar_kernel_loses)
{
    const tetrace::Scene scene = tetrace::make_cubes(7);
    const auto packed = pack(scene, tetrace::Layout::half32, tetrace::TetOrder::hilbert);
    tetrace::RaySet set = hard_ray_set(scene, 0, 4000);
    for (std::size_t i = 1; i < set.rays.size(); i += 2)
        set.rays[i].end = 0.5f;
    for (const std::uint32_t most : {1u, 2u, 9u})
        expect_scalar_bits_given(packed, set, "at most " + std::to_string(most) + " steps", most);
}

TEST(Packets, lose_the_rays_that_the_scalar_kernel_loses)
{
    const DeviceRays rays(tetrace::make_cubes(7), tetrace::Layout::half32);
    for (const std::uint32_t most : {1u, 2u, 9u}) {
        for (TraceJob job : {rays.from_outside(40, 40), rays.from_inside(40, 24)}) {
            job.max_steps = most;
            EXPECT_GT(count_of(scalar_hits(rays, job), LOST), 0);
            expect_scalar_bits(rays, job, "at most " + std::to_string(most) + " steps");
        }
    }
}

TEST(Packets, have_the_scalar_kernels_bits_where_links_lead_to_wrong_tets)
{
    const tetrace::DeviceRays rays(tetrace::test::make_damaged_cubes(6), tetrace::Layout::half32);
    std::ptrdiff_t lost = 0;
    for (const TraceJob& job : {rays.from_outside(64, 48), rays.from_outside(32, 24, 0), rays.from_inside(64, 48)}) {
        lost += count_of(scalar_hits(rays, job), LOST);
        expect_scalar_bits(rays, job, job.start_tet == NO_TET ? "from outside" : "from inside");
    }
    EXPECT_GT(lost, 0);
}

TEST(Packets, are_a_schedule_of_openmp_for_one_kernel)
{
    auto& openmp = tetrace::openmp_backend();
    EXPECT_TRUE(openmp.has_kernel(packets));
    EXPECT_TRUE(openmp.why_not(0, packets).empty());
    EXPECT_EQ(openmp.devices().front().group_width, packet_kernels().front().lanes);
    KernelId other = packets;
    other.layout = tetrace::Layout::tet80;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.method = tetrace::Method::maria;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.math = tetrace::MathMode::fast;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.task = tetrace::Task::rays;
    EXPECT_TRUE(openmp.has_kernel(other));
    other.layout = tetrace::Layout::tet80;
    EXPECT_FALSE(openmp.has_kernel(other));
}

TEST(Packets, come_in_every_width_up_to_the_processors_and_always_in_one)
{
    const auto& kernels = packet_kernels();
    ASSERT_FALSE(kernels.empty());
    EXPECT_EQ(kernels.back().lanes, 4u);
    EXPECT_TRUE(std::is_sorted(kernels.begin(), kernels.end(),
                               [](const PacketKernel& a, const PacketKernel& b) { return a.lanes > b.lanes; }));
    for (const PacketKernel& kernel : kernels)
        RecordProperty("lanes", std::to_string(kernel.lanes));
}
