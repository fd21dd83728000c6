#include "core/mesh/domain.h"

#include "core/base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

using namespace tetrace;

namespace {

const TriangleMesh low_triangle{{{0.1f, 0.2f, 0.3f}, {0.5f, 0.25f, 0.3f}, {0.3f, 0.6f, 0.3f}}, {{0, 1, 2}}};

} // namespace

TEST(Domain, tight_is_the_box_grown_by_2_percent_of_its_largest_extent)
{
    const Domain domain = make_domain(low_triangle, DomainKind::tight, 8);
    EXPECT_NEAR(domain.low().x, 0.1 - 0.01 * 0.4, 2e-6);
    EXPECT_NEAR(domain.high().y, 0.6 + 0.01 * 0.4, 2e-6);
    EXPECT_NEAR(domain.high().z - domain.low().z, 2 * 0.01 * 0.4, 4e-6) << "a flat mesh still gets a box";
    for (const Float3 v : low_triangle.vertices)
        EXPECT_TRUE(domain.contains(v));
}

TEST(Domain, wide_is_a_cube_of_half_size_3_radii)
{
    const Domain domain = make_domain(low_triangle, DomainKind::wide, 1);
    const BoundingSphere sphere = bounding_sphere(low_triangle);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(domain.high()[axis] - domain.low()[axis], 6 * sphere.radius, 4e-6);
}

TEST(Domain, lines_are_exact_multiples_of_2_to_the_minus_20_and_ascend)
{
    for (const auto kind : {DomainKind::tight, DomainKind::wide}) {
        const Domain domain = make_domain(low_triangle, kind, 7);
        for (const auto& lines : domain.lines) {
            ASSERT_EQ(lines.size(), 8u);
            EXPECT_TRUE(std::is_sorted(lines.begin(), lines.end()));
            for (const float line : lines)
                EXPECT_EQ(line * 0x1p20f, static_cast<float>(static_cast<long>(line * 0x1p20f)));
        }
    }
}

TEST(Domain, a_mesh_too_small_for_its_place_is_refused)
{
    const float x = 0.75f, e = 0x1p-23f;
    const TriangleMesh tiny{{{x, x, x}, {x + e, x, x}, {x, x + e, x}}, {{0, 1, 2}}};
    EXPECT_THROW((void)make_domain(tiny, DomainKind::tight, 8), Error);
}

TEST(Domain, surface_is_closed_wound_outwards_and_has_two_triangles_a_square)
{
    const Domain domain = make_domain(low_triangle, DomainKind::tight, 3);
    const TriangleMesh surface = domain_surface(domain);
    EXPECT_EQ(surface.triangles.size(), 6u * 3 * 3 * 2);
    EXPECT_EQ(surface.vertices.size(), 4u * 4 * 4 - 2 * 2 * 2);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0;
    for (const auto& [a, b, c] : surface.triangles) {
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            ++edges[{from, to}];
        volume +=
            dot(to_double(surface.vertices[a]), cross(to_double(surface.vertices[b]), to_double(surface.vertices[c]))) /
            6;
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    const Double3 size = to_double(domain.high()) - to_double(domain.low());
    EXPECT_NEAR(volume, size.x * size.y * size.z, 1e-9);
}
