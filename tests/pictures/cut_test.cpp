// The cut through a mesh: each pixel has the tet that is there, and a tally over its volume.
#include "bench/pictures/cut.h"
#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"
#include "scenes/export_tets.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace tetrace;

namespace {

constexpr std::uint32_t cut_width = 40, cut_height = 30;

View view_from(Double3 origin, Double3 target = {0, 0, 0})
{
    return make_view(aimed_camera({origin, target}, {{0, 0, 0}, 1}), cut_width, cut_height);
}

double volume(Double3 a, Double3 b, Double3 c, Double3 d)
{
    return std::abs(dot(cross(b - a, c - a), d - a)) / 6;
}

} // namespace

TEST(Cut, has_at_each_pixel_the_tet_in_which_its_point_is)
{
    const Scene scene = make_cubes(4);
    const View view = view_from({2, 1.1, 0.7});
    const auto tets = tets_on_cut(scene, view, cut_width, cut_height);
    const Double3 low = to_double(scene.domain.low()), high = to_double(scene.domain.high());
    const Double3 middle = (low + high) * 0.5, origin = to_double(view.origin);
    const Double3 normal = cross(to_double(view.step_x), to_double(view.step_y));
    std::size_t inside = 0;
    for (std::uint32_t i = 0; i < tets.size(); ++i) {
        const Double3 direction = to_double(view.corner) + to_double(view.step_x) * (i % cut_width) +
                                  to_double(view.step_y) * (i / cut_width);
        const Double3 at = origin + direction * (dot(middle - origin, normal) / dot(direction, normal));
        const bool in_box =
            at.x > low.x && at.x < high.x && at.y > low.y && at.y < high.y && at.z > low.z && at.z < high.z;
        ASSERT_EQ(tets[i] != NO_TET, in_box) << i;
        if (!in_box) continue;
        ++inside;
        const auto corner = [&](std::size_t k) {
            return to_double(scene.tets.vertices[scene.tets.tets[tets[i]].vertices[k]]);
        };
        const Double3 a = corner(0), b = corner(1), c = corner(2), d = corner(3);
        EXPECT_NEAR(volume(at, b, c, d) + volume(a, at, c, d) + volume(a, b, at, d) + volume(a, b, c, at),
                    volume(a, b, c, d), 1e-9 * volume(a, b, c, d))
            << i;
    }
    EXPECT_GT(inside, tets.size() / 4);
    EXPECT_LT(inside, tets.size());
}

TEST(Cut, shows_sums_over_volumes_in_percent_of_the_mean)
{
    const Scene scene = make_cubes(3);
    const auto tets = tets_on_cut(scene, view_from({0.3, 0.2, 2}), cut_width, cut_height);
    const std::vector<double> volumes = volumes_of(scene);
    std::vector<std::uint64_t> sums(volumes.size());
    std::ranges::transform(volumes, sums.begin(), [](double v) { return static_cast<std::uint64_t>(1e12 * v); });
    const std::uint32_t chosen =
        *std::ranges::max_element(tets, {}, [](std::uint32_t t) { return t == NO_TET ? 0 : t; });
    sums[chosen] = 0;
    const std::vector<Hit> pixels = tally_at_pixels(tets, sums, volumes);
    const auto others = static_cast<std::uint32_t>(std::lround(100 / (1 - volumes[chosen] / [&] {
                                                                   double sum = 0;
                                                                   for (const double v : volumes)
                                                                       sum += v;
                                                                   return sum;
                                                               }())));
    for (std::size_t i = 0; i < tets.size(); ++i)
        EXPECT_EQ(pixels[i].steps, tets[i] == NO_TET || tets[i] == chosen ? 0 : others) << i;
    EXPECT_EQ(tally_at_pixels(tets, std::vector<std::uint64_t>(sums.size()), volumes)[0].steps, 0u) << "no rays";
}

TEST(Cut, needs_a_camera_that_looks_towards_the_scene)
{
    EXPECT_THROW((void)tets_on_cut(make_cubes(3), view_from({0, 0, 2}, {0, 0, 2.5}), cut_width, cut_height), Error);
}
