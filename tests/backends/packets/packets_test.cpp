// Packets of each width give the bits of the scalar kernel.
#include "backends/openmp/packet_session.h"
#include "core/base/error.h"
#include "core/device/given_quads.h"
#include "tests/support/damaged_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/packet_widths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

using namespace tetrace;
using namespace test;

namespace {

using openmp::packet_kernel;
using openmp::packet_kernels;
using openmp::PacketKernel;

constexpr KernelId scalar{.method = Method::project, .layout = Layout::half32};
constexpr KernelId packets{.method = Method::project, .layout = Layout::half32, .schedule = Schedule::packets};

std::vector<Hit> scalar_hits(const DeviceRays& rays, const TraceJob& job)
{
    return traced(*openmp_backend().open(0, scalar, rays.data(), {.threads = 2}), job);
}

std::ptrdiff_t count_of(const std::vector<Hit>& hits, std::uint32_t face_id)
{
    return std::count_if(hits.begin(), hits.end(), [&](const Hit& hit) { return hit.face_id == face_id; });
}

std::vector<Hit> traced_given(Session& session, const std::vector<Quad>& quads, const TraceJob& job)
{
    session.set_rays(quads);
    return traced(session, job);
}

/// Of each width, skipped where it is missing.
class Packets : public PacketWidths {
protected:
    static void expect_scalar_bits(const DeviceRays& rays, const TraceJob& job, const std::string& what)
    {
        const auto session = openmp_backend().open(0, packets, rays.data(), {.threads = 2, .packet_lanes = GetParam()});
        EXPECT_EQ(different_rays(traced(*session, job), scalar_hits(rays, job), 0), 0u)
            << job.width << " x " << job.height << ", " << what;
    }

    /// max_steps: 0 for as many as no walk takes.
    static void expect_scalar_bits_given(const PackedScene& packed, const RaySet& set, const std::string& what,
                                         std::uint32_t max_steps = 0)
    {
        const TraceJob job = given_job(set.rays.size(), max_steps == 0 ? packed.tet_count + 1 : max_steps, set.any_hit);
        const auto hits_of = [&](KernelId kernel) {
            kernel.task = Task::rays;
            const SessionOptions options{.threads = 2, .packet_lanes = GetParam()};
            const auto session = openmp_backend().open(0, kernel, {nullptr, &packed}, options);
            return traced_given(*session, given_quads(set, packed), job);
        };
        EXPECT_EQ(different_rays(hits_of(packets), hits_of(scalar), 0), 0u) << set.rays.size() << " rays, " << what;
    }
};

} // namespace

TETRACE_EACH_PACKET_WIDTH(Packets);

TEST_P(Packets, have_the_scalar_kernels_bits_from_outside_and_inside_whatever_the_images_size)
{
    const DeviceRays rays(make_cubes(7), Layout::half32);
    for (const TraceJob& job : jobs_of_all_kinds(rays))
        expect_scalar_bits(rays, job, job.start_tet == NO_TET ? "from outside" : "from inside");
}

TEST_P(Packets, have_the_scalar_kernels_bits_where_rays_pass_vertices_and_edges)
{
    const auto lines = even_lines(8, 1);
    const DeviceRays rays(grid_of({lines, lines, lines}), Layout::half32);
    expect_scalar_bits(rays, along_lines(17, 17, {0.25f, 0, 3}), "along lines");
    expect_scalar_bits(rays, along_lines(17, 17, {0, 0, 4}), "on an axis");
    expect_scalar_bits(rays, along_lines(50, 41, {0.1f, 0.2f, 3}), "next to lines");
    expect_scalar_bits(rays, along_lines(23, 9, {3, 3, 3}), "along a diagonal");
}

TEST_P(Packets, of_views_along_each_axis_and_of_all_round_have_the_scalar_kernels_bits)
{
    // All deepest axes, both ways, and packets in which they change.
    const DeviceRays rays(make_cubes(5), Layout::half32);
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            Float3 origin{}, corner{-1.5f, -1.5f, -1.5f}, step_x{}, step_y{};
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

TEST_P(Packets, of_given_rays_of_every_kind_have_the_scalar_kernels_bits)
{
    for (const bool inside : {false, true}) {
        const GivenScene cubes(96, inside);
        const auto packed = pack(cubes.scene, Layout::half32, TetOrder::chains);
        for (const RayKind kind : {RayKind::primary, RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random}) {
            const RaySet set = make_rays(kind, cubes.source());
            ASSERT_FALSE(set.rays.empty());
            expect_scalar_bits_given(packed, set, std::string(name_of(kind)) + (inside ? ", inside" : ", outside"));
        }
    }
}

TEST_P(Packets, of_given_rays_that_pass_vertices_and_edges_have_the_scalar_kernels_bits)
{
    for (const auto& [name, scene] : make_hard_scenes()) {
        const auto packed = pack(scene, Layout::half32, TetOrder::chains);
        RaySet set = hard_ray_set(scene, 0, 9 * 2048);
        expect_scalar_bits_given(packed, set, name);
        for (std::size_t i = 1; i < set.rays.size(); i += 2)
            set.rays[i].end = 0.375f;
        expect_scalar_bits_given(packed, set, std::string(name) + ", some with ends");
    }
}

TEST_P(Packets, of_given_rays_have_the_scalar_kernels_bits_however_many_they_are)
{
    const Scene scene = make_cubes(5);
    const auto packed = pack(scene, Layout::half32, TetOrder::chains);
    for (const std::size_t count : {8u, 24u, 40u, 504u, 512u, 520u, 16'400u})
        expect_scalar_bits_given(packed, hard_ray_set(scene, 7, count), "two threads that take 512 at once");
}

TEST_P(Packets, of_given_rays_lose_those_that_the_scalar_kernel_loses)
{
    const Scene scene = make_cubes(7);
    const auto packed = pack(scene, Layout::half32, TetOrder::chains);
    RaySet set = hard_ray_set(scene, 0, 4000);
    for (std::size_t i = 1; i < set.rays.size(); i += 2)
        set.rays[i].end = 0.5f;
    for (const std::uint32_t most : {1u, 2u, 9u})
        expect_scalar_bits_given(packed, set, "at most " + std::to_string(most) + " steps", most);
}

TEST_P(Packets, lose_the_rays_that_the_scalar_kernel_loses)
{
    const DeviceRays rays(make_cubes(7), Layout::half32);
    for (const std::uint32_t most : {1u, 2u, 9u}) {
        for (TraceJob job : {rays.from_outside(40, 40), rays.from_inside(40, 24)}) {
            job.max_steps = most;
            EXPECT_GT(count_of(scalar_hits(rays, job), LOST), 0);
            expect_scalar_bits(rays, job, "at most " + std::to_string(most) + " steps");
        }
    }
}

TEST_P(Packets, have_the_scalar_kernels_bits_where_links_lead_to_wrong_tets)
{
    const DeviceRays rays(make_damaged_cubes(6), Layout::half32);
    std::ptrdiff_t lost = 0;
    for (const TraceJob& job : {rays.from_outside(64, 48), rays.from_outside(32, 24, 0), rays.from_inside(64, 48)}) {
        lost += count_of(scalar_hits(rays, job), LOST);
        expect_scalar_bits(rays, job, job.start_tet == NO_TET ? "from outside" : "from inside");
    }
    EXPECT_GT(lost, 0);
}

TEST(PacketSchedule, is_one_of_openmp_for_one_kernel)
{
    auto& openmp = openmp_backend();
    EXPECT_TRUE(openmp.has_kernel(packets));
    EXPECT_TRUE(openmp.why_not(0, packets).empty());
    EXPECT_EQ(openmp.devices().front().group_width, packet_kernels().front().lanes);
    KernelId other = packets;
    other.layout = Layout::tet80;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.method = Method::maria;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.math = MathMode::fast;
    EXPECT_FALSE(openmp.has_kernel(other));
    other = packets;
    other.task = Task::rays;
    EXPECT_TRUE(openmp.has_kernel(other));
    other.layout = Layout::tet80;
    EXPECT_FALSE(openmp.has_kernel(other));
}

TEST(PacketSchedule, has_every_width_up_to_the_widest_and_always_the_smallest)
{
    std::vector<unsigned> widths;
    for (const PacketKernel& kernel : packet_kernels())
        widths.insert(widths.begin(), kernel.lanes);
    const auto& all = packet_widths;
    ASSERT_FALSE(widths.empty());
    ASSERT_LE(widths.size(), std::size(all));
    EXPECT_TRUE(std::equal(widths.begin(), widths.end(), all));
    EXPECT_EQ(packet_kernel(0).lanes, widths.back());
    for (const unsigned lanes : widths)
        EXPECT_EQ(packet_kernel(lanes).lanes, lanes);
}

TEST(PacketSchedule, names_the_widths_there_are_where_one_is_missing)
{
    const DeviceRays rays(make_cubes(2), Layout::half32);
    for (const unsigned lanes : {8u, 16u, 32u}) {
        if (lanes <= packet_kernels().front().lanes) continue;
        try {
            (void)openmp_backend().open(0, packets, rays.data(), {.packet_lanes = lanes});
            ADD_FAILURE() << lanes << " lanes";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::unsupported);
            EXPECT_TRUE(std::string(error.what()).ends_with(", 4") || std::string(error.what()).ends_with(" 4"))
                << error.what();
        }
    }
}
