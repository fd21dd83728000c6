// Task segments on rays that are built to break a walk, and the places of S2.
#include "scenes/load.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/domain_chord.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/maria_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <numbers>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::size_t crossed_at_once = 1 << 14;

/// TETRACE_HARD_RAYS is how many rays per scene gets.
std::uint64_t crossed_rays()
{
    const char* const text = std::getenv("TETRACE_HARD_RAYS");
    return text == nullptr ? 9'000 : std::strtoull(text, nullptr, 10);
}

struct CrossedRays {
    Verdicts verdicts;
    std::uint64_t reversed = 0, crossings = 0;
};

/// Hard rays; for maria only the chords, in general position: others lead it astray in circles and past faces.
RaySet rays_for(Method method, const Scene& scene, std::uint64_t first, std::size_t count)
{
    RaySet set = hard_ray_set(scene, first, count);
    if (method == Method::project) return set;
    const HardRays rays(scene);
    for (std::size_t i = 0; i < count; ++i) {
        set.rays[i] = rays.ray((first + i) * hard_kinds);
        set.rays[i].pixel = static_cast<std::uint32_t>(i);
    }
    return set;
}

/// Of a method's walks on tet80, which its other layouts must share.
CrossedRays crossed_by(Method method, const std::vector<Layout>& others, const Scene& scene, std::uint64_t count)
{
    const CrossedScene tets(scene, method, Layout::tet80);
    CrossedRays all;
    for (std::uint64_t first = 0; first < count; first += crossed_at_once) {
        const std::size_t size = std::min<std::uint64_t>(crossed_at_once, count - first) / TILE_WIDTH * TILE_WIDTH;
        const RaySet set = rays_for(method, scene, first, size);
        const std::vector<Hit> answers = tets.answers(set);
        for (const Layout layout : others)
            for (std::size_t i = 0; const Hit& answer : CrossedScene(scene, method, layout).answers(set)) {
                EXPECT_EQ(segments_of(answer), segments_of(answers[i])) << name_of(layout) << " ray " << first + i;
                ++i;
            }
        const Verdicts verdicts = tets.judged(set, answers, tets.walks(set));
        all.verdicts.add(verdicts);
        if (!verdicts.flawed.empty()) {
            const Segments flawed = segments_of(verdicts.first_wrong->ours);
            ADD_FAILURE() << "ray " << first + verdicts.flawed.front() << ", " << flawed.crossings
                          << " crossings: " << verdicts.first_wrong->reason;
        }
        for (const Hit& answer : answers) {
            all.reversed += segments_of(answer).reversed;
            all.crossings += segments_of(answer).crossings;
        }
    }
    return all;
}

void expect_all_right(Method method, const std::vector<Layout>& others, const Scene& scene,
                      const std::string& scene_name)
{
    const auto [verdicts, reversed, crossings] = crossed_by(method, others, scene, crossed_rays());
    const std::string name = fmt::format("{}, {}", scene_name, name_of(method));
    fmt::print("{}: {} rays, {} crossings: {} agree, {} ties, {} wrong, {} lost; {} reversed\n", name, verdicts.rays,
               crossings, verdicts.agreed, verdicts.ties, verdicts.wrong, verdicts.lost, reversed);
    EXPECT_EQ(verdicts.wrong + verdicts.lost, 0u) << name;
    EXPECT_GT(verdicts.agreed, verdicts.rays / 4) << name;
}

namespace kernel = tetrace::test::maria;

using Order = std::array<std::size_t, 3>;
constexpr std::array<Order, 6> orders{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

std::uint32_t place_of(const GivenRay& ray, const std::array<Float3, 3>& corners, const Order& order)
{
    return kernel::place_on_face(kernel::make_ray(kernel::to_vec3(ray.origin), kernel::to_vec3(ray.direction)),
                                 kernel::to_vec3(corners[order[0]]), kernel::to_vec3(corners[order[1]]),
                                 kernel::to_vec3(corners[order[2]]), stretch_of(ray.direction));
}

/// Corners on a coarse grid around the ray's line, so that many are seen in one line, or in one point.
std::array<Float3, 3> corners_near(const GivenRay& ray, Random& random, bool is_coarse)
{
    std::array<Float3, 3> corners;
    for (Float3& corner : corners) {
        const Float3 offset = is_coarse ? Float3{0.125F * static_cast<float>(random.below(3)) - 0.125F,
                                                 0.125F * static_cast<float>(random.below(3)) - 0.125F,
                                                 0.125F * static_cast<float>(random.below(3)) - 0.125F}
                                        : random.point(-0.25F, 0.25F);
        const float t = 0.25F * static_cast<float>(random.below(4));
        for (int axis = 0; axis < 3; ++axis)
            corner[axis] =
                snap_to_grid(std::clamp(ray.origin[axis] + t * ray.direction[axis] + offset[axis], -1.0F, 1.0F));
    }
    return corners;
}

} // namespace

TEST(Segments, of_hard_rays_are_neither_lost_nor_wrong)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_all_right(Method::project, {Layout::tet96, Layout::half32, Layout::tet64}, scene, name);
}

TEST(Segments, of_chords_are_neither_lost_nor_wrong_by_maria)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_all_right(Method::maria, {Layout::tet96}, scene, name);
}

// Their walks are judged, not trusted: a ray that is lost or wrong is a number, and ends.
TEST(Segments, of_other_programs_rules_get_chords_right_and_some_hard_rays_wrong)
{
    for (const Method method :
         {Method::plane, Method::plucker, Method::stp, Method::ms06, Method::plucker64, Method::barycentric}) {
        Verdicts chords, hard;
        for (const auto& [name, scene] : make_hard_scenes()) {
            const CrossedScene tets(scene, method, Layout::tet80);
            for (Verdicts* const verdicts : {&chords, &hard}) {
                const RaySet set = verdicts == &hard ? hard_ray_set(scene, 0, 4096) : rays_for(method, scene, 0, 4096);
                verdicts->add(tets.judged(set, tets.answers(set), tets.walks(set)));
            }
        }
        EXPECT_EQ(chords.wrong + chords.lost, 0u) << name_of(method);
        EXPECT_GT(hard.wrong + hard.lost, method == Method::plucker ? hard.rays / 100 : 0u) << name_of(method);
        fmt::print("{}: {} wrong and {} lost of {} chords; {} and {} of {} hard rays\n", name_of(method), chords.wrong,
                   chords.lost, chords.rays, hard.wrong, hard.lost, hard.rays);
    }
}

TEST(Segments, a_circle_is_found_long_before_the_cap)
{
    const Scene scene = make_cubes(2);
    PackedScene packed = pack(scene, Layout::tet96, TetOrder::chains);
    for (std::size_t quad = 0; quad < packed.tets.size(); ++quad) // every face leads to face 0 of tet 1
        if (quad % TET96_QUADS >= 4) packed.tets[quad].x = packed.tets[quad].z = 1u << 2u;
    kernel::TraceParams params{};
    params.max_steps = 0xFFFFFFFF; // steps that would take minutes
    const RaySet set = hard_ray_set(scene, 0, 360);
    const auto quads = segment_quads(set, packed);
    std::size_t lost = 0;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const auto answer =
            kernel::cross_tets(kernel::view_of(packed), params, NO_SUMS, false, quads[i], quads[set.rays.size() + i]);
        if (answer.first == LOST) ++lost;
        EXPECT_TRUE(answer.first == LOST || answer.first == NO_HIT) << i;
    }
    EXPECT_GT(lost, 200u);
}

TEST(Segments, add_up_to_the_chord_of_the_domain)
{
    const Scene scene = make_cubes(6);
    const CrossedScene tets(scene, Method::project, Layout::half32);
    RaySet set = hard_ray_set(scene, 0, 3600);
    std::size_t compared = 0;
    for (std::size_t i = 0; const Hit& answer : tets.answers(set)) {
        const GivenRay& ray = set.rays[i++];
        const auto chord = chord_of_domain(scene.domain, ray);
        if (!chord) continue;
        EXPECT_NEAR(length_of(segments_of(answer).length), *chord, 64 * tie_bound(ray.origin)) << i - 1;
        ++compared;
    }
    EXPECT_GT(compared, 500u);
}

TEST(Segments, of_uniform_lines_have_the_mean_length_of_integral_geometry)
{
    const Scene scene = make_cubes(3);
    const CrossedScene tets(scene, Method::project, Layout::tet64);
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    const HardRays rays(scene);
    for (std::uint64_t i = 0; i < 40'000; ++i) // kind chord: between two uniform points of a sphere
        set.rays.push_back(rays.ray(i * hard_kinds));
    std::vector<double> sum(scene.tets.tets.size()), squares(scene.tets.tets.size());
    for (const CrossedTets& walk : tets.walks(set)) {
        std::uint32_t farthest = walk.places.empty() ? 0 : walk.places.front();
        for (std::size_t i = 0; i < walk.tets.size(); ++i) {
            const std::uint32_t next = std::max(farthest, walk.places[i + 1]);
            const double length = length_of(next - farthest);
            sum[tets.mesh_of_packed()[walk.tets[i]]] += length;
            squares[tets.mesh_of_packed()[walk.tets[i]]] += length * length;
            farthest = next;
        }
    }
    const CrossedScene tallied(scene, Method::project, Layout::tet64, Task::tally);
    const auto session = tallied.session(2);
    static_cast<void>(tallied.answers(*session, set));
    for (std::size_t tet = 0; const std::uint64_t units : session->tally())
        EXPECT_EQ(length_of(units), sum[tets.mesh_of_packed()[tet++]]) << "the tally's sums are those tested below";
    const double radius = 0.53125 * length(to_double(scene.domain.high()) - to_double(scene.domain.low()));
    const auto count = static_cast<double>(set.rays.size());
    double chi_square = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        std::array<Double3, 4> corners{};
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] = to_double(scene.tets.vertices[scene.tets.tets[i].vertices[k]]);
        const double volume =
            std::abs(dot(corners[1] - corners[0], cross(corners[2] - corners[0], corners[3] - corners[0]))) / 6;
        const double expected = volume / (std::numbers::pi * radius * radius); // 4 V / S a line
        const double variance = squares[i] / count - expected * expected;
        const double off = (sum[i] / count - expected) / std::sqrt(variance / count);
        EXPECT_LT(std::abs(off), 5) << "tet " << i;
        chi_square += off * off;
    }
    const auto tets_count = static_cast<double>(sum.size());
    EXPECT_NEAR(chi_square / tets_count, 1, 6 * std::sqrt(2 / tets_count));
}

TEST(Places, are_the_same_for_every_order_of_the_corners)
{
    const Scene scene = make_cubes(3);
    const HardRays rays(scene);
    Random random(46);
    std::size_t on_lines = 0;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        const GivenRay ray = rays.ray(i);
        const auto corners = corners_near(ray, random, i % 2 == 0);
        const std::uint32_t place = place_of(ray, corners, orders[0]);
        for (const Order& order : orders)
            ASSERT_EQ(place_of(ray, corners, order), place) << i;
        const bool is_line = corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2];
        if (is_line) ++on_lines;
        std::array<std::uint32_t, 3> own{};
        for (std::size_t k = 0; k < 3; ++k)
            own[k] = place_of(ray, {corners[k], corners[k], corners[k]}, orders[0]);
        const auto [first, last] = std::ranges::minmax(own);
        const std::uint32_t rounding = 4 + ((last - first) >> 20u); // 12 e of the extent, and units
        ASSERT_GE(place + rounding, first) << i;
        ASSERT_LE(place, last + rounding) << i;
    }
    EXPECT_GT(on_lines, 100u);
}

// Rays next to thin triangles: the place is that of the foot on the long edge, or of its end.
TEST(Places, are_nearest_where_a_ray_passes_outside)
{
    Random random(47);
    for (int i = 0; i < 20'000; ++i) {
        const Float3 tilt = random.point(-0.5F, 0.5F);
        const GivenRay ray{random.point(-0.3F, 0.3F), {tilt.x, tilt.y, 1}, NO_END, NO_HALF_FACE, FREE_FACE, 0};
        const double angle = random.point(0, 7).x, foot = random.point(-0.3F, 1.3F).x, third = random.point(0, 1).x;
        const double beside = std::ldexp(1.0, -12 - static_cast<int>(random.below(14)));
        const double width =
            std::ldexp(static_cast<double>(random.below(3)) - 1, -12 - static_cast<int>(random.below(14)));
        const double first = random.point(0, 0.4F).x, rise = random.point(-0.2F, 0.2F).x;
        const auto corner = [&](double share, double across) {
            const double along = 0.5 * (share - foot), z = first + share * rise;
            const Double3 o = to_double(ray.origin), u = to_double(ray.direction);
            return Float3{static_cast<float>(o.x + z * u.x + along * std::cos(angle) - across * std::sin(angle)),
                          static_cast<float>(o.y + z * u.y + along * std::sin(angle) + across * std::cos(angle)),
                          static_cast<float>(o.z + z)};
        };
        const std::array<Float3, 3> corners{corner(0, beside), corner(1, beside), corner(third, beside + width)};
        const double expected = 2 + ray.origin.z + first + std::clamp(foot, 0.0, 1.0) * rise;
        const std::uint32_t place = place_of(ray, corners, orders[0]);
        for (const Order& order : orders)
            ASSERT_EQ(place_of(ray, corners, order), place) << i;
        ASSERT_NEAR(length_of(place), expected * length(to_double(ray.direction)),
                    4 * (beside + std::abs(width)) + 0x1p-18)
            << i;
    }
}
