// The tets and rays of exit searches: each ray enters its tet by the face that it says, and leaves by those that
// another exact arithmetic finds; a wrong face is distinguished from one within rounding.
#include "backends/openmp/backend.h"
#include "core/base/exact.h"
#include "core/base/hash.h"
#include "core/mesh/tet_mesh.h"
#include "core/rays/search_set.h"

#include <array>
#include <bit>
#include <gtest/gtest.h>
#include <vector>

using namespace tetrace;

namespace {

constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Float3 vector_of(const Quad& quad)
{
    return {std::bit_cast<float>(quad.x), std::bit_cast<float>(quad.y), std::bit_cast<float>(quad.z)};
}

using Tet4 = std::array<Float3, 4>;

/// Of layout tet96, whose first four quads are the corners.
Tet4 tet_at(const PackedScene& tets, std::size_t number)
{
    Tet4 corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = vector_of(tets.tets[TET96_QUADS * number + i]);
    return corners;
}

struct TestRay {
    Float3 origin, direction, moment;
};
TestRay ray_at(const SearchRays& rays, std::size_t number)
{
    return {vector_of(rays.quads[rays.count() + number]), vector_of(rays.quads[number]),
            vector_of(rays.quads[2 * rays.count() + number])};
}

ExactCrossing cross_face(const TestRay& ray, const Tet4& tet, std::size_t face)
{
    const auto& [a, b, c] = faces[face];
    return cross_exactly(ray.origin, ray.direction, tet[a], tet[b], tet[c]);
}

/// In domain units, between the ray's line and that of the edge.
double distance(const TestRay& ray, Float3 from, Float3 to)
{
    const Double3 across = cross(to_double(ray.direction), to_double(to) - to_double(from));
    return std::abs(dot(to_double(from) - to_double(ray.origin), across)) / length(across);
}

/// Of the edges that the face does not share with the entry face, the furthest from the ray and the nearest to it.
std::pair<double, double> distances(const TestRay& ray, const Tet4& tet, std::size_t face, std::size_t entry)
{
    double furthest = 0, nearest = 1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = faces[face][i], b = faces[face][(i + 1) % 3];
        if (a != entry && b != entry) continue; // the apex of the entry face is opposite it
        furthest = std::max(furthest, distance(ray, tet[a], tet[b]));
        nearest = std::min(nearest, distance(ray, tet[a], tet[b]));
    }
    return {furthest, nearest};
}

} // namespace

TEST(SearchSet, tets_have_a_volume_and_the_orientation_of_packed_ones)
{
    const PackedScene tets = search_tets(2000, Layout::tet96);
    ASSERT_EQ(tets.tets.size(), 2000u * TET96_QUADS);
    for (std::size_t i = 0; i < 2000; ++i) {
        const Tet4 tet = tet_at(tets, i);
        EXPECT_EQ(orientation(tet[0], tet[1], tet[2], tet[3]), -1) << i;
        for (const Float3 corner : tet)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(corner[axis] >= -1 && corner[axis] < 1);
    }
}

TEST(SearchSet, is_the_same_on_every_machine)
{
    EXPECT_EQ(hash_of(search_tets(100, Layout::tet80).tets), 9813976517486629394u);
    EXPECT_EQ(hash_of(search_rays(0, 100, 64).quads), 16852513402178649653u);
}

TEST(SearchSet, a_tet_is_the_same_in_both_layouts_and_in_any_number_of_them)
{
    const PackedScene few = search_tets(3, Layout::tet80), many = search_tets(50, Layout::tet80);
    EXPECT_TRUE(std::equal(few.tets.begin(), few.tets.end(), many.tets.begin()));
    const PackedScene wide = search_tets(3, Layout::tet96);
    for (std::size_t tet = 0; tet < 3; ++tet)
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Quad quad = wide.tets[TET96_QUADS * tet + corner];
            const auto* words = &few.tets[TET80_QUADS * tet].x + 3 * corner;
            EXPECT_TRUE(quad.x == words[0] && quad.y == words[1] && quad.z == words[2] && quad.w == 0);
        }
}

TEST(SearchSet, rays_of_a_tet_are_the_same_whatever_the_batch)
{
    const SearchRays all = search_rays(0, 4, 16), part = search_rays(2, 2, 8);
    for (std::size_t i = 0; i < part.count(); ++i) {
        const std::size_t same = (2 + i / 8) * 16 + i % 8;
        EXPECT_EQ(part.quads[i], all.quads[same]);
        EXPECT_EQ(part.quads[part.count() + i], all.quads[all.count() + same]);
        EXPECT_EQ(part.exits[i], all.exits[same]);
    }
}

TEST(SearchSet, rays_enter_by_their_face_and_leave_by_the_exits)
{
    const PackedScene tets = search_tets(300, Layout::tet96);
    const SearchRays rays = search_rays(0, 300, 64);
    std::array<std::size_t, 16> entries_and_exits{};
    for (std::size_t i = 0; i < rays.count(); ++i) {
        ASSERT_EQ(half_face_tet(rays.half_face(i)), i / 64);
        const Tet4 tet = tet_at(tets, i / 64);
        const TestRay ray = ray_at(rays, i);
        const std::size_t entry = half_face_index(rays.half_face(i));
        const ExactCrossing in = cross_face(ray, tet, entry);
        ASSERT_TRUE(in.met) << i;
        unsigned exits = 0;
        for (std::size_t face = 0; face < 4; ++face) {
            const ExactCrossing out = cross_face(ray, tet, face);
            if (face == entry || !out.met) continue;
            EXPECT_GT(out.t, in.t) << "it starts before the tet, and enters first";
            exits |= 1u << face;
            ++entries_and_exits[4 * entry + face];
        }
        EXPECT_EQ(rays.exits[i], exits) << i;
        const Float3 p = ray.origin, u = ray.direction;
        EXPECT_EQ(ray.moment, (Float3{p.y * u.z - p.z * u.y, p.z * u.x - p.x * u.z, p.x * u.y - p.y * u.x}));
    }
    for (std::size_t i = 0; i < 16; ++i) // twelve pairs of faces, each as often as the others
        EXPECT_NEAR(static_cast<double>(entries_and_exits[i]), i % 5 == 0 ? 0 : 1600, 200) << i;
}

TEST(SearchSet, a_face_within_rounding_is_a_tie_and_any_other_is_wrong)
{
    const PackedScene tets = search_tets(100, Layout::tet96);
    const SearchRays rays = search_rays(0, 100, 4096);
    std::size_t ties = 0;
    for (std::size_t i = 0; i < rays.count(); ++i) {
        const std::size_t entry = half_face_index(rays.half_face(i));
        EXPECT_EQ(judge(rays, i, NO_EXIT), SearchVerdict::lost);
        EXPECT_EQ(judge(rays, i, static_cast<std::uint32_t>(entry)), SearchVerdict::wrong);
        for (std::size_t face = 0; face < 4; ++face) {
            const SearchVerdict verdict = judge(rays, i, static_cast<std::uint32_t>(face));
            EXPECT_EQ(verdict == SearchVerdict::right, (rays.exits[i] >> face & 1u) != 0);
            if (verdict == SearchVerdict::right || face == entry) continue;
            const TestRay ray = ray_at(rays, i);
            const auto [furthest, nearest] = distances(ray, tet_at(tets, i / 4096), face, entry);
            if (verdict == SearchVerdict::tie) {
                EXPECT_LE(nearest, tie_bound(ray.origin));
                ++ties;
            } else {
                EXPECT_GT(furthest, tie_bound(ray.origin));
            }
        }
    }
    EXPECT_GT(ties, 0u);
    EXPECT_LT(ties, 400u) << "of 819,200: edges within 4e-6 of a ray are rare";
}

TEST(SearchSet, openmp_finds_the_exits_with_every_method)
{
    const SearchRays rays = search_rays(0, 200, 512);
    for (const KernelId& kernel : kernels_of(Task::search)) {
        if (!openmp_backend().why_not(0, kernel).empty()) continue;
        const PackedScene tets = search_tets(200, kernel.layout);
        const auto session = openmp_backend().open(0, kernel, {nullptr, &tets}, {.threads = 2});
        session->set_rays(rays.quads);
        std::vector<std::uint32_t> found(rays.count());
        EXPECT_GT(session->search(search_job(rays.count()), found), 0);
        std::size_t others = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (judge(rays, i, found[i]) != SearchVerdict::right) ++others;
        EXPECT_LE(others, 20u) << name_of(kernel) << ' ' << name_of(kernel.math) << ", of 102,400";
    }
}

TEST(SearchSet, kernels_are_those_of_the_cdt_with_a_ray_an_item)
{
    for (const KernelId& kernel : kernels_of(Task::search)) {
        EXPECT_EQ(kernel.structure, Structure::cdt);
        EXPECT_EQ(kernel.schedule, Schedule::tiles);
    }
    EXPECT_EQ(name_of(kernels_of(Task::search).front()), "search/plane/tet80");
}
