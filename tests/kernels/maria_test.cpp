#include "bench/reproduce/operations/counted_methods.h"
#include "core/base/exact.h"
#include "tests/support/random_tets.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;
using namespace tetrace::counted::maria;

namespace {

Ray ray_of(Float3 origin, Float3 direction)
{
    return make_ray(to_vec3(origin), to_vec3(direction));
}

} // namespace

TEST(Faces, corners_wind_one_way_on_all_faces)
{
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const RandomTet tet = random_tet(random);
        for (uint face = 0; face < 4; ++face)
            EXPECT_LT(orientation(tet.corners[face], tet.corners[corner(face, 0)], tet.corners[corner(face, 1)],
                                  tet.corners[corner(face, 2)]),
                      0);
    }
}

TEST(Maria, a_step_is_28_operations_and_a_start_three_products)
{
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const auto packed = packed_tets({random_tet(random)});
        const Ray ray = ray_of(random.point(-2, 2), random_direction(random));
        for (uint entry = 0; entry < 4; ++entry) {
            Counted::operations = 0;
            (void)exit_face(view_of(packed), 0, entry, ray);
            EXPECT_EQ(Counted::operations, 28);
        }
        Counted::operations = 0;
        (void)start_face(view_of(packed), 0, ray);
        EXPECT_EQ(Counted::operations, 3 * (3 + 9 + 3 + 5));
    }
}

TEST(Maria, leaves_by_the_face_that_the_exact_line_leaves_by)
{
    Random random(6);
    int compared = 0;
    int differing = 0;
    for (int i = 0; i < 20000; ++i) {
        const RandomTet tet = random_tet(random);
        const Float3 origin = random.point(-2, 2);
        const Float3 direction = direction_between(origin, inner_point(tet, random));
        const Crossed crossed = crossed_faces(tet, origin, direction);
        if (crossed.count != 2) continue;
        const auto packed = packed_tets({tet});
        ++compared;
        differing += exit_face(view_of(packed), 0, crossed.first, ray_of(origin, direction)) != crossed.last;
    }
    EXPECT_GT(compared, 15000);
    EXPECT_LE(differing, compared / 10000) << "only a line within rounding of an edge may leave by its other face";
}

namespace {

// A tet with corners on a coarse grid, so that the whole step is exact: a point on an edge is on it in float too.
RandomTet coarse_tet(Random& random)
{
    for (;;) {
        RandomTet tet;
        for (Float3& corner_point : tet.corners)
            for (int axis = 0; axis < 3; ++axis)
                corner_point[axis] = 0x1p-8f * 12 * (static_cast<float>(random.below(5)) - 2);
        if (orient(tet)) return tet;
    }
}

} // namespace

// The tie rule of the paper's Table 1: a product of zero counts as "not negative" in both tests.
TEST(Maria, a_line_through_an_edge_leaves_by_the_face_that_the_tie_rule_names)
{
    Random random(9);
    constexpr uint excluded[] = {1, 2,
                                 0}; // the exit is opposite this corner when the line meets the edge of c0, c1, c2
    for (int i = 0; i < 500; ++i) {
        const RandomTet tet = coarse_tet(random);
        const auto packed = packed_tets({tet});
        for (uint entry = 0; entry < 4; ++entry) {
            for (uint on_edge = 0; on_edge < 3; ++on_edge) {
                Float3 inside_face, on_apex_edge, direction, origin;
                for (int axis = 0; axis < 3; ++axis) {
                    const auto at = [&](uint k) { return tet.corners[corner(entry, k)][axis]; };
                    inside_face[axis] = (at(0) + at(1) + 2 * at(2)) / 4;
                    on_apex_edge[axis] = (at(on_edge) + tet.corners[entry][axis]) / 2;
                    direction[axis] = on_apex_edge[axis] - inside_face[axis];
                    origin[axis] = inside_face[axis] - direction[axis];
                }
                ASSERT_EQ(exit_face(view_of(packed), 0, entry, ray_of(origin, direction)),
                          corner(entry, excluded[on_edge]))
                    << "entry " << entry << ", edge of corner " << on_edge;
            }
        }
    }
}

TEST(Ray, a_pixel_s_tiny_direction_components_are_dropped)
{
    TraceParams params{};
    params.corner = VEC3(Counted(0x1p-21f), Counted(0x1p-20f), Counted(1));
    const Ray ray = primary_ray(params, 0, 0);
    EXPECT_EQ(ray.direction.x.value, 0.0f);
    EXPECT_EQ(ray.direction.y.value, 0x1p-20f);
}

TEST(Maria, starts_by_the_face_that_the_exact_ray_leaves_by)
{
    Random random(7);
    int compared = 0;
    int differing = 0;
    for (int i = 0; i < 20000; ++i) {
        const RandomTet tet = random_tet(random);
        const Float3 origin = inner_point(tet, random);
        const Float3 direction = random_direction(random);
        const Crossed crossed = crossed_faces(tet, origin, direction);
        if (crossed.count != 1) continue; // the origin fell on a face, or the ray meets an edge
        const auto packed = packed_tets({tet});
        ++compared;
        differing += start_face(view_of(packed), 0, ray_of(origin, direction)) != crossed.last;
    }
    EXPECT_GT(compared, 15000);
    EXPECT_LE(differing, compared / 10000);
}
