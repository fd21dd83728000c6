#include "bench/rows/scene_work.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

Scene wide_cubes()
{
    Scene scene = make_cubes(5);
    scene.domain.kind = DomainKind::wide;
    return scene;
}

/// A camera on a circle inside the domain; every step moves it by a 64th.
std::vector<Float3> circle()
{
    std::vector<Float3> origins;
    for (int i = 0; i < 64; ++i) {
        const float angle = 0.1f * static_cast<float>(i);
        origins.push_back({0.61f * std::cos(angle), 0.61f * std::sin(angle), 0.123f});
    }
    return origins;
}

Float3 middle_of(const Scene& scene, std::uint32_t tet)
{
    Float3 middle{};
    for (const std::uint32_t vertex : scene.tets.tets[tet].vertices)
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] += 0.25f * scene.tets.vertices[vertex][axis];
    return snap_to_grid(middle);
}

} // namespace

TEST(ViewStarts, in_the_wide_domain_a_camera_walks_to_the_starts_of_exact_location)
{
    const Scene scene = wide_cubes();
    const ViewStarts found = find_starts(scene, circle());
    ASSERT_EQ(found.starts.size(), 64u);
    for (std::size_t view = 0; view < 64; ++view)
        EXPECT_EQ(found.starts[view], find_start(scene, circle()[view]));
    ASSERT_TRUE(found.walk);
    EXPECT_EQ(found.walk->counts.located, 1u);
    EXPECT_EQ(found.walk->counts.walked, 63u);
    EXPECT_GT(found.walk->exact_s, 0);
}

TEST(ViewStarts, in_the_tight_domain_each_is_located_on_its_own)
{
    const Scene scene = make_cubes(5);
    const ViewStarts found = find_starts(scene, circle());
    EXPECT_FALSE(found.walk);
    EXPECT_EQ(found.starts[7], find_start(scene, circle()[7]));
}

// A mesh with two copies of a tet, one of which is reached only from a neighbour: the walk ends in that one.
TEST(ViewStarts, a_walk_that_ends_elsewhere_is_an_error)
{
    const Scene scene = wide_cubes();
    const auto twin = static_cast<std::uint32_t>(scene.tets.tets.size());
    for (std::uint32_t first = 0; first < twin; ++first)
        for (std::size_t face = 0; face < 4; ++face) {
            const std::uint32_t half_face = scene.tets.tets[first].neighbours[face];
            if (half_face == NO_HALF_FACE) continue;
            Scene twins = scene;
            twins.tets.tets.push_back(scene.tets.tets[half_face_tet(half_face)]);
            twins.tets.tets[first].neighbours[face] = make_half_face(twin, half_face_index(half_face));
            const Float3 from = middle_of(scene, first), to = middle_of(scene, half_face_tet(half_face));
            if (locate(twins.tets, from) != first || locate(twins.tets, to) != half_face_tet(half_face)) continue;
            EXPECT_THROW((void)find_starts(twins, {from, to}), Error);
            EXPECT_NO_THROW((void)find_starts(scene, {from, to}));
            return;
        }
    FAIL() << "no such pair of tets";
}
