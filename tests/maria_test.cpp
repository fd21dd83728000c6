#include "core/backend.h"
#include "core/exact.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace {

// A number that counts what is done with it.
struct Counted {
    float value = 0;
    static inline int operations = 0;

    Counted() = default;
    explicit Counted(float v) : value(v) {}
    friend Counted operator+(Counted a, Counted b) { return operations++, Counted(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return operations++, Counted(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return operations++, Counted(a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return operations++, Counted(a.value / b.value); }
    friend Counted operator-(Counted a) { return Counted(-a.value); }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
};

#define KERNEL_REAL Counted
#define KERNEL_REAL_HAS_NO_BITS
#define KERNEL_LAYOUT_HEADER "kernels/tet96.h"
#define KERNEL_METHOD_HEADER "kernels/maria.h"
#include "kernels/kernel_cpp.h"

using tetrace::Float3;
using tetrace::orientation;

struct RandomTet {
    Float3 corners[4];
};

// One tet in layout tet96, without neighbours.
tetrace::PackedScene packed_tet(const RandomTet& tet)
{
    tetrace::PackedScene packed;
    packed.layout = tetrace::Layout::tet96;
    packed.tet_count = 1;
    for (const Float3 v : tet.corners)
        packed.tets.push_back({std::bit_cast<uint>(v.x), std::bit_cast<uint>(v.y), std::bit_cast<uint>(v.z), 0});
    packed.tets.resize(TET96_ROWS, {NO_LINK, FREE_FACE, NO_LINK, FREE_FACE});
    return packed;
}

RandomTet random_tet(tetrace::test::Random& random)
{
    for (;;) {
        RandomTet tet{{random.point(-1, 1), random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)}};
        const int sign = orientation(tet.corners[0], tet.corners[1], tet.corners[2], tet.corners[3]);
        if (sign > 0) std::swap(tet.corners[2], tet.corners[3]);
        if (sign != 0) return tet;
    }
}

Float3 direction_of(tetrace::test::Random& random)
{
    Float3 d;
    for (int axis = 0; axis < 3; axis++)
        d[axis] = without_dust(Counted(random.between(-1, 1))).value;
    return d;
}

Float3 inner_point(const RandomTet& tet, tetrace::test::Random& random)
{
    const float weight[4] = {random.unit(), random.unit(), random.unit(), random.unit()};
    const float sum = weight[0] + weight[1] + weight[2] + weight[3];
    Float3 point;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 4; k++)
            point[axis] += tet.corners[k][axis] * weight[k] / sum;
    return tetrace::snap_to_grid(point);
}

Float3 toward(Float3 from, Float3 to)
{
    Float3 d;
    for (int axis = 0; axis < 3; axis++)
        d[axis] = without_dust(Counted(to[axis] - from[axis])).value;
    return d;
}

// Faces that the exact line crosses in their interior, in the order in which it does.
struct Crossed {
    int count = 0;
    uint first = 4, last = 4;
};
Crossed crossed_faces(const RandomTet& tet, Float3 origin, Float3 direction)
{
    std::vector<std::pair<double, uint>> crossings;
    for (uint face = 0; face < 4; face++) {
        const auto c = tetrace::cross_exactly(origin, direction, tet.corners[corner(face, 0)],
                                              tet.corners[corner(face, 1)], tet.corners[corner(face, 2)]);
        const int sum = c.edge_side[0] + c.edge_side[1] + c.edge_side[2];
        if (c.met && std::abs(sum) == 3) crossings.push_back({c.t, face});
    }
    if (crossings.empty()) return {};
    std::sort(crossings.begin(), crossings.end());
    return {static_cast<int>(crossings.size()), crossings.front().second, crossings.back().second};
}

Ray ray_of(Float3 origin, Float3 direction)
{
    return make_ray(to_vec3(origin), to_vec3(direction));
}

TEST(Faces, corners_wind_one_way_on_all_faces)
{
    tetrace::test::Random random(4);
    for (int i = 0; i < 100; i++) {
        const RandomTet tet = random_tet(random);
        for (uint face = 0; face < 4; face++)
            EXPECT_LT(orientation(tet.corners[face], tet.corners[corner(face, 0)], tet.corners[corner(face, 1)],
                                  tet.corners[corner(face, 2)]),
                      0);
    }
}

TEST(Maria, a_step_is_28_operations_and_a_start_three_products)
{
    tetrace::test::Random random(5);
    for (int i = 0; i < 1000; i++) {
        const auto packed = packed_tet(random_tet(random));
        const Ray ray = ray_of(random.point(-2, 2), direction_of(random));
        for (uint entry = 0; entry < 4; entry++) {
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
    tetrace::test::Random random(6);
    int compared = 0;
    int differing = 0;
    for (int i = 0; i < 20000; i++) {
        const RandomTet tet = random_tet(random);
        const Float3 origin = random.point(-2, 2);
        const Float3 direction = toward(origin, inner_point(tet, random));
        const Crossed crossed = crossed_faces(tet, origin, direction);
        if (crossed.count != 2) continue;
        const auto packed = packed_tet(tet);
        compared++;
        differing += exit_face(view_of(packed), 0, crossed.first, ray_of(origin, direction)) != crossed.last;
    }
    EXPECT_GT(compared, 15000);
    EXPECT_LE(differing, compared / 10000) << "only a line within rounding of an edge may leave by its other face";
}

// A tet with corners on a coarse grid, where the whole step is exact: what falls on an edge, falls on it in float too.
RandomTet coarse_tet(tetrace::test::Random& random)
{
    for (;;) {
        RandomTet tet;
        for (Float3& corner_point : tet.corners)
            for (int axis = 0; axis < 3; axis++)
                corner_point[axis] = 0x1p-8f * 12 * (static_cast<float>(random.below(5)) - 2);
        const int sign = orientation(tet.corners[0], tet.corners[1], tet.corners[2], tet.corners[3]);
        if (sign > 0) std::swap(tet.corners[2], tet.corners[3]);
        if (sign != 0) return tet;
    }
}

// The tie rule of the paper's Table 1: a product of zero counts as "not negative" in both tests.
TEST(Maria, a_line_through_an_edge_leaves_by_the_face_that_the_tie_rule_names)
{
    tetrace::test::Random random(9);
    constexpr uint excluded[] = {1, 2,
                                 0}; // the exit is opposite this corner when the line meets the edge of c0, c1, c2
    for (int i = 0; i < 500; i++) {
        const RandomTet tet = coarse_tet(random);
        const auto packed = packed_tet(tet);
        for (uint entry = 0; entry < 4; entry++) {
            for (uint on_edge = 0; on_edge < 3; on_edge++) {
                Float3 inside_face, on_apex_edge, direction, origin;
                for (int axis = 0; axis < 3; axis++) {
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
    tetrace::test::Random random(7);
    int compared = 0;
    int differing = 0;
    for (int i = 0; i < 20000; i++) {
        const RandomTet tet = random_tet(random);
        const Float3 origin = inner_point(tet, random);
        const Float3 direction = direction_of(random);
        const Crossed crossed = crossed_faces(tet, origin, direction);
        if (crossed.count != 1) continue; // the origin fell on a face, or the ray meets an edge
        const auto packed = packed_tet(tet);
        compared++;
        differing += start_face(view_of(packed), 0, ray_of(origin, direction)) != crossed.last;
    }
    EXPECT_GT(compared, 15000);
    EXPECT_LE(differing, compared / 10000);
}

} // namespace
