#include "bench/pictures/shading.h"

#include "core/base/error.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

constexpr Double3 viewer{0, 0, 1}, right{1, 0, 0}, up{0, 1, 0};

double brightness(Colour colour)
{
    return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b;
}

/// Looks along -z at the z = 0 plane, two by one pixels.
View small_view()
{
    return {{0, 0, 2}, {-0.5f, 0, -1}, {1, 0, 0}, {0, -1, 0}};
}

/// A square in the z = 0 plane as two triangles of opposite winding.
TriangleMesh square()
{
    return {{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, {{0, 1, 2}, {0, 3, 2}}};
}

Hit hit_of(std::uint32_t face)
{
    return {face, 0, 1.0f, 0.0f, 0.0f, 3};
}

} // namespace

TEST(Shade, faces_towards_the_light_are_brighter_than_faces_seen_edge_on)
{
    const double towards = brightness(shade(viewer, viewer, right, up));
    const double edge_on = brightness(shade(right, viewer, right, up));
    EXPECT_GT(towards, 2.0 * edge_on);
}

TEST(Shade, the_sky_lights_more_than_the_ground)
{
    EXPECT_GT(brightness(shade(up, viewer, right, up)), brightness(shade(up * -1.0, viewer, right, up)));
}

TEST(Shade, no_direction_is_black_or_burnt_out)
{
    for (int i = 0; i < 64; ++i) {
        const double angle = i * 0.0982, tilt = i * 0.31;
        const Double3 normal =
            normalized({std::cos(angle) * std::cos(tilt), std::sin(tilt), std::abs(std::sin(angle))});
        const Colour colour = shade(normal, viewer, right, up);
        EXPECT_GT(brightness(colour), 0.02);
        EXPECT_LT(brightness(colour), 1.0);
    }
}

TEST(ShadeHits, both_windings_of_a_triangle_look_alike)
{
    const std::vector<Hit> one{hit_of(0), hit_of(0)}, other{hit_of(1), hit_of(1)};
    EXPECT_EQ(shade_hits(one, small_view(), 2, 1, square()).pixels,
              shade_hits(other, small_view(), 2, 1, square()).pixels);
}

TEST(ShadeHits, lost_rays_stand_out_from_misses_and_hits)
{
    const std::vector<Hit> hits{hit_of(LOST), hit_of(NO_HIT)};
    const Pixmap pixmap = shade_hits(hits, small_view(), 2, 1, square());
    EXPECT_EQ(pixmap.at(0, 0), lost_colour());
    EXPECT_GT(brightness(pixmap.at(1, 0)), 0.6) << "the background is light";
}

TEST(ShadeHits, refuses_hits_that_were_never_written)
{
    const std::vector<Hit> hits{hit_of(0), hit_of(POISON)};
    EXPECT_THROW((void)shade_hits(hits, small_view(), 2, 1, square()), Error);
}

TEST(LayersOfHits, have_the_hits_and_normals_towards_the_viewer)
{
    const std::vector<Hit> ahead{hit_of(0), hit_of(1)}, none{hit_of(LOST), {NO_HIT, NO_TET, 0, 0, 0, 7}};
    const HitLayers both = layers_of_hits(ahead, small_view(), 2, 1, square());
    EXPECT_EQ(both.pixels, (std::vector<HitPixel>{{1, 3, {0, 0, 1}, 0}, {1, 3, {0, 0, 1}, 1}}));
    EXPECT_EQ(layers_of_hits(none, small_view(), 2, 1, square()).pixels,
              (std::vector<HitPixel>{{1, 3, {}, LOST}, {0, 7, {}, NO_HIT}}));
    const std::vector<Hit> unwritten{hit_of(0), hit_of(POISON)};
    EXPECT_THROW((void)layers_of_hits(unwritten, small_view(), 2, 1, square()), Error);
}

TEST(ShadeHits, draws_triangles_without_area)
{
    const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    const std::vector<Hit> hits{hit_of(0), hit_of(0)};
    EXPECT_GT(brightness(shade_hits(hits, small_view(), 2, 1, needle).at(0, 0)), 0.1);
}
