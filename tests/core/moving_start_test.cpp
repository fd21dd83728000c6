#include "core/mesh/locate.h"

#include "core/base/exact.h"
#include "scenes/procedural.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const Scene& cubes_of_9()
{
    static const Scene cubes = make_cubes(9);
    return cubes;
}

bool holds(std::uint32_t tet, Float3 point)
{
    for (std::size_t face = 0; face < 4; ++face) {
        Float3 corners[4];
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = cubes_of_9().tets.vertices[cubes_of_9().tets.tets[tet].vertices[i]];
        corners[face] = point;
        if (orientation(corners[0], corners[1], corners[2], corners[3]) > 0) return false;
    }
    return true;
}

/// Where a camera is at a time in [0, 1]: a curve inside the domain.
Float3 on_curve(float time)
{
    const Double3 high = to_double(cubes_of_9().domain.high());
    const double angle = 7 * static_cast<double>(time), reach = 0.2 + 0.7 * static_cast<double>(time);
    return snap_to_grid(Float3{static_cast<float>(high.x * reach * std::cos(angle)),
                               static_cast<float>(high.y * reach * std::sin(angle)),
                               static_cast<float>(high.z * 0.9 * std::sin(3 * angle))});
}

const MoveLimit no_limit{HUGE_VAL, UINT32_MAX};

} // namespace

TEST(WalkTo, arrives_in_a_tet_that_holds_the_point_from_any_tet)
{
    Random random(11);
    const Float3 low = cubes_of_9().domain.low(), high = cubes_of_9().domain.high();
    const auto tets = static_cast<std::uint32_t>(cubes_of_9().tets.tets.size());
    for (int i = 0; i < 2000; ++i) {
        const Float3 point = snap_to_grid(
            Float3{random.between(low.x, high.x), random.between(low.y, high.y), random.between(low.z, high.z)});
        const WalkEnd end = walk_to(cubes_of_9().tets, random.below(tets), point, UINT32_MAX);
        ASSERT_EQ(end.kind, WalkEnd::Kind::arrived);
        EXPECT_TRUE(holds(end.tet, point));
    }
}

TEST(WalkTo, arrives_on_vertices_edges_and_faces_in_one_of_the_tets_that_share_them)
{
    Random random(12);
    const auto count = static_cast<std::uint32_t>(cubes_of_9().tets.tets.size());
    for (std::uint32_t i = 0; i < count; i += 7) {
        const auto& corners = cubes_of_9().tets.tets[i].vertices;
        const auto& at = cubes_of_9().tets.vertices;
        const Float3 a = at[corners[0]], b = at[corners[1]];
        const Float3 middle = snap_to_grid({0.5f * (a.x + b.x), 0.5f * (a.y + b.y), 0.5f * (a.z + b.z)});
        for (const Float3 point : {a, middle}) {
            const WalkEnd end = walk_to(cubes_of_9().tets, random.below(count), point, UINT32_MAX);
            ASSERT_EQ(end.kind, WalkEnd::Kind::arrived);
            EXPECT_TRUE(holds(end.tet, point));
        }
    }
}

TEST(WalkTo, takes_no_more_steps_than_it_may_and_says_when_it_is_outside)
{
    const Float3 from = on_curve(0), to = on_curve(1);
    const std::uint32_t first = locate(cubes_of_9().tets, from);
    const WalkEnd whole = walk_to(cubes_of_9().tets, first, to, UINT32_MAX);
    ASSERT_GT(whole.steps, 5u);
    const WalkEnd cut = walk_to(cubes_of_9().tets, first, to, whole.steps - 1);
    EXPECT_EQ(cut.kind, WalkEnd::Kind::too_far);
    EXPECT_EQ(cut.tet, NO_TET);
    EXPECT_EQ(cut.steps, whole.steps - 1);
    EXPECT_EQ(walk_to(cubes_of_9().tets, first, to, whole.steps).tet, whole.tet);
    EXPECT_EQ(walk_to(cubes_of_9().tets, first, from, 0).tet, first) << "no step is needed";
    const WalkEnd beyond = walk_to(cubes_of_9().tets, first, {0, 0, 50}, UINT32_MAX);
    EXPECT_EQ(beyond.kind, WalkEnd::Kind::outside);
    EXPECT_EQ(beyond.tet, NO_TET);
}

TEST(MovingStart, each_start_is_that_of_exact_location)
{
    MovingStart camera(cubes_of_9(), no_limit);
    for (int i = 0; i <= 500; ++i) {
        const Float3 origin = on_curve(static_cast<float>(i) / 500);
        ASSERT_EQ(camera.next(origin), find_start(cubes_of_9(), origin)) << i;
    }
    EXPECT_EQ(camera.counts().located, 1u) << "only the first";
    EXPECT_EQ(camera.counts().walked, 500u);
    EXPECT_GT(camera.counts().steps, 0u);
    EXPECT_LT(camera.counts().max_steps, camera.counts().steps);
}

TEST(MovingStart, a_camera_that_goes_from_vertex_to_vertex_starts_where_exact_location_says)
{
    MovingStart camera(cubes_of_9(), no_limit);
    for (std::size_t i = 0; i < cubes_of_9().tets.vertices.size(); i += 5)
        ASSERT_EQ(camera.next(cubes_of_9().tets.vertices[i]), find_start(cubes_of_9(), cubes_of_9().tets.vertices[i]));
    EXPECT_GT(camera.counts().walked, camera.counts().located);
}

TEST(MovingStart, small_moves_take_few_steps)
{
    MovingStart camera(cubes_of_9(), no_limit), far(cubes_of_9(), no_limit);
    for (int i = 0; i < 400; ++i) {
        (void)camera.next(on_curve(static_cast<float>(i) / 400));
        (void)far.next(on_curve(static_cast<float>(i * 199 % 400) / 400));
    }
    EXPECT_LT(3 * camera.counts().steps, far.counts().steps);
}

TEST(MovingStart, a_move_over_the_maximum_distance_is_not_walked)
{
    const Float3 from = on_curve(0), to = on_curve(1);
    const double distance = length(to_double(to) - to_double(from));
    for (const double limit : {0.99 * distance, 1.01 * distance}) {
        MovingStart camera(cubes_of_9(), {limit, UINT32_MAX});
        (void)camera.next(from);
        EXPECT_EQ(camera.next(to), find_start(cubes_of_9(), to));
        EXPECT_EQ(camera.counts().walked, limit > distance ? 1u : 0u);
        EXPECT_EQ(camera.counts().steps == 0, limit < distance);
    }
}

TEST(MovingStart, a_walk_that_takes_too_many_steps_is_given_up_for_exact_location)
{
    MovingStart camera(cubes_of_9(), {HUGE_VAL, 3});
    (void)camera.next(on_curve(0));
    EXPECT_EQ(camera.next(on_curve(1)), find_start(cubes_of_9(), on_curve(1)));
    EXPECT_EQ(camera.counts().located, 2u);
    EXPECT_EQ(camera.counts().max_steps, 3u);
}

TEST(MovingStart, a_camera_may_leave_the_domain_and_come_back)
{
    MovingStart camera(cubes_of_9(), no_limit);
    const Float3 inside = on_curve(0.3f), outside{0, 0, 3}, farther{0, 3, 3};
    for (const Float3 origin : {outside, inside, outside, farther, inside})
        EXPECT_EQ(camera.next(origin), find_start(cubes_of_9(), origin));
    EXPECT_EQ(camera.next(outside).tet, NO_TET);
    EXPECT_EQ(camera.counts().walked, 2u) << "twice out of the domain; there is no way from outside";
}

TEST(MovingStart, the_usual_limit_is_a_quarter_of_the_domains_longest_side)
{
    const Double3 extent = to_double(cubes_of_9().domain.high()) - to_double(cubes_of_9().domain.low());
    EXPECT_EQ(usual_move_limit(cubes_of_9().domain).distance, std::max({extent.x, extent.y, extent.z}) / 4);
}
