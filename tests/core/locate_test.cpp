#include "core/mesh/locate.h"

#include "core/base/exact.h"
#include "scenes/procedural.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

int side_of_face(const Scene& scene, std::uint32_t tet, std::size_t face, Float3 point)
{
    Float3 corners[4];
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = scene.tets.vertices[scene.tets.tets[tet].vertices[i]];
    corners[face] = point;
    return orientation(corners[0], corners[1], corners[2], corners[3]);
}

int faces_touched(const Scene& scene, std::uint32_t tet, Float3 point)
{
    int touched = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const int side = side_of_face(scene, tet, face, point);
        EXPECT_LE(side, 0) << "the tet does not hold the point";
        touched += side == 0;
    }
    return touched;
}

Float3 midpoint(Float3 a, Float3 b)
{
    return {0.5f * (a.x + b.x), 0.5f * (a.y + b.y), 0.5f * (a.z + b.z)};
}

const Scene& cubes_of_7()
{
    static const Scene cubes = make_cubes(7);
    return cubes;
}

} // namespace

TEST(Locate, finds_the_tet_of_random_points)
{
    Random random(3);
    const Float3 low = cubes_of_7().domain.low(), high = cubes_of_7().domain.high();
    for (int i = 0; i < 2000; ++i) {
        const Float3 point = snap_to_grid(
            Float3{random.between(low.x, high.x), random.between(low.y, high.y), random.between(low.z, high.z)});
        const auto tet = locate(cubes_of_7().tets, point);
        ASSERT_NE(tet, NO_TET);
        (void)faces_touched(cubes_of_7(), tet, point);
    }
}

TEST(Locate, finds_a_tet_for_every_vertex_and_edge_midpoint)
{
    for (std::size_t i = 0; i < cubes_of_7().tets.tets.size(); i += 11) {
        const Tet& tet = cubes_of_7().tets.tets[i];
        const Float3 a = cubes_of_7().tets.vertices[tet.vertices[0]], b = cubes_of_7().tets.vertices[tet.vertices[1]];
        const auto at_vertex = locate(cubes_of_7().tets, a);
        ASSERT_NE(at_vertex, NO_TET);
        EXPECT_EQ(faces_touched(cubes_of_7(), at_vertex, a), 3);
        const Float3 middle = snap_to_grid(midpoint(a, b));
        ASSERT_NE(locate(cubes_of_7().tets, middle), NO_TET);
    }
}

TEST(Locate, points_outside_the_domain_have_no_tet)
{
    const Float3 high = cubes_of_7().domain.high();
    EXPECT_EQ(locate(cubes_of_7().tets, {high.x + 0x1p-20f, high.y, high.z}), NO_TET);
    EXPECT_EQ(locate(cubes_of_7().tets, {0, 0, 50}), NO_TET);
    EXPECT_NE(locate(cubes_of_7().tets, high), NO_TET) << "the domain is closed";
}

TEST(FindStart, keeps_a_camera_inside_a_tet_where_it_is)
{
    const Float3 inside{0.0123f, 0.0456f, -0.0789f};
    EXPECT_EQ(find_start(cubes_of_7(), inside).origin, inside);
}

TEST(FindStart, moves_a_camera_off_vertices_and_edges_by_little)
{
    for (std::size_t i = 0; i < cubes_of_7().tets.tets.size(); i += 37) {
        const Tet& tet = cubes_of_7().tets.tets[i];
        const Float3 a = cubes_of_7().tets.vertices[tet.vertices[0]];
        for (const Float3 camera : {a, snap_to_grid(midpoint(a, cubes_of_7().tets.vertices[tet.vertices[1]]))}) {
            const Start start = find_start(cubes_of_7(), camera);
            ASSERT_NE(start.tet, NO_TET);
            EXPECT_EQ(faces_touched(cubes_of_7(), start.tet, start.origin), 0);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_LE(std::abs(start.origin[axis] - camera[axis]), 0x1p-12f);
        }
    }
}

TEST(FindStart, a_camera_outside_has_no_tet)
{
    const Start start = find_start(cubes_of_7(), {0, 0, 3});
    EXPECT_EQ(start.tet, NO_TET);
    EXPECT_EQ(start.origin, (Float3{0, 0, 3}));
}
