#include "core/rays/camera_set.h"

#include "core/base/exact.h"
#include "core/base/hash.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

const BoundingSphere sphere{{0.125, -0.25, 0.0625}, 0.75};
/// Its box has that sphere.
const TriangleMesh seen_triangle{{{-0.375F, -0.75F, -0.1875F}, {0.625F, 0.25F, 0.3125F}, {0.625F, -0.75F, 0.3125F}},
                                 {{0, 1, 2}}};

std::uint64_t hash_of_views(CameraSet set)
{
    std::uint64_t hash = 0;
    for (const Camera& camera : make_cameras(set, seen_triangle)) {
        const View view[] = {make_view(camera, 640, 480)};
        hash = hash_of(view, hash);
    }
    return hash;
}

} // namespace

TEST(Camera, sets_have_their_number_of_views)
{
    for (const CameraSet set : values_of<CameraSet>())
        EXPECT_EQ(make_cameras(set, seen_triangle).size(), view_count(set)) << name_of(set);
    EXPECT_EQ(view_count(CameraSet::orbit), 1282u);
}

// The bits were computed once; any machine that rounds as IEEE 754 says must find them again.
TEST(Camera, views_are_reproducible_to_the_bit)
{
    EXPECT_EQ(hash_text(hash_of_views(CameraSet::smoke)), "4d1513413c151f6f");
    EXPECT_EQ(hash_text(hash_of_views(CameraSet::orbit)), "d29c88ee819a9d51");
    EXPECT_EQ(hash_text(hash_of_views(CameraSet::flight)), "d8de445c68713f91");
}

TEST(Camera, distances_are_those_of_the_set)
{
    for (const Camera& camera : make_cameras(CameraSet::orbit, seen_triangle))
        EXPECT_NEAR(length(to_double(camera.origin) - sphere.centre), 2 * sphere.radius, 1e-6);
    double nearest = 9, farthest = 0;
    for (const Camera& camera : make_cameras(CameraSet::flight, seen_triangle)) {
        const double radii = length(to_double(camera.origin) - sphere.centre) / sphere.radius;
        nearest = std::min(nearest, radii);
        farthest = std::max(farthest, radii);
    }
    EXPECT_NEAR(nearest, 1.2, 0.01);
    EXPECT_NEAR(farthest, 2.9, 0.01);
}

TEST(Camera, frames_are_orthonormal_and_look_at_the_centre)
{
    for (const auto set : {CameraSet::smoke, CameraSet::orbit, CameraSet::flight}) {
        for (const Camera& camera : make_cameras(set, seen_triangle)) {
            EXPECT_NEAR(dot(camera.forward, camera.right), 0, 1e-12);
            EXPECT_NEAR(dot(camera.forward, camera.up), 0, 1e-12);
            EXPECT_NEAR(length(camera.up), 1, 1e-12);
            const Double3 to_centre = normalized(sphere.centre - to_double(camera.origin));
            EXPECT_NEAR(dot(camera.forward, to_centre), 1, 1e-12);
            EXPECT_EQ(camera.origin, snap_to_grid(camera.origin));
        }
    }
}

TEST(Camera, pixels_span_60_degrees_through_their_centres)
{
    const Camera camera = make_cameras(CameraSet::smoke, seen_triangle).front();
    const View view = make_view(camera, 1024, 512);
    const auto direction = [&](double x, double y) {
        return to_double(view.corner) + to_double(view.step_x) * x + to_double(view.step_y) * y;
    };
    // The image's middle is between four pixels; half a pixel outside the outermost centres are 30 degrees to each
    // side.
    EXPECT_NEAR(length(direction(511.5, 255.5) - camera.forward), 0, 1e-6);
    EXPECT_NEAR(dot(direction(-0.5, 255.5), camera.right), -0.57735026919, 1e-6);
    EXPECT_NEAR(dot(direction(1023.5, 255.5), camera.right), 0.57735026919, 1e-6);
    EXPECT_NEAR(dot(direction(511.5, -0.5), camera.up), 0.57735026919 / 2, 1e-6) << "row 0 is the top";
}
