#include "core/rays/ray_set.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/base/hash.h"
#include "core/base/random_words.h"
#include "core/mesh/tet_mesh.h"
#include "core/rays/ray_start.h"
#include "tests/support/given_scene.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr RayKind all_kinds[] = {RayKind::primary, RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random};
constexpr RayKind secondary_kinds[] = {RayKind::shadow, RayKind::ao, RayKind::diffuse};

// Made once: most cases only read it.
const GivenScene& outside()
{
    static const GivenScene made;
    return made;
}

Tet tet_of_start(const Scene& scene, const GivenRay& ray)
{
    return scene.tets.tets[half_face_tet(ray.half_face)];
}

std::array<Float3, 4> face_and_apex(const Scene& scene, std::uint32_t half_face)
{
    const auto& vertices = scene.tets.tets[half_face_tet(half_face)].vertices;
    const auto& [a, b, c] = face_corners[half_face_index(half_face)];
    const auto at = [&](std::uint32_t i) { return scene.tets.vertices[vertices[i]]; };
    return {at(a), at(b), at(c), at(half_face_index(half_face))};
}

Double3 inward_normal(const Scene& scene, std::uint32_t half_face)
{
    const auto [a, b, c, apex] = face_and_apex(scene, half_face);
    const Double3 normal = normalized(cross(to_double(b) - to_double(a), to_double(c) - to_double(a)));
    return dot(normal, to_double(apex) - to_double(a)) > 0 ? normal : normal * -1;
}

} // namespace

TEST(RandomWords, are_those_of_philox_4x32_10)
{
    // Known answers of Random123's own tests (kat_vectors, philox4x32 10).
    EXPECT_EQ(random_words({0, 0, 0, 0}, 0), (RandomWords{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
}

TEST(RandomWords, directions_are_uniform_and_of_length_1)
{
    Double3 sum, squares;
    constexpr std::uint32_t count = 20'000;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Double3 d = random_direction({99, 0, i, 0});
        EXPECT_NEAR(length(d), 1, 1e-15);
        sum = sum + d;
        squares = squares + Double3{d.x * d.x, d.y * d.y, d.z * d.z};
    }
    // Standard deviations of the means: sqrt(1/3 / n) = 0.0041 and sqrt(4/45 / n) = 0.0021; four of each.
    for (const double mean : {sum.x / count, sum.y / count, sum.z / count})
        EXPECT_NEAR(mean, 0, 0.0164);
    for (const double mean : {squares.x / count, squares.y / count, squares.z / count})
        EXPECT_NEAR(mean, 1.0 / 3, 0.0085);
}

TEST(RaySet, every_kind_is_the_same_bits_on_every_machine)
{
    std::vector<std::string> hashes;
    for (const RayKind kind : all_kinds)
        hashes.push_back(hash_text(ray_hash(make_rays(kind, outside().source()))));
    EXPECT_EQ(hashes, (std::vector<std::string>{"049a3440624ae9b2", "3a2683ebccada2a8", "12cee3a80c92854d",
                                                "79e23b065dff5797", "ff7894c3c50abaad"}));
}

TEST(RaySet, depends_on_the_view_and_not_on_how_tets_are_ordered)
{
    const GivenScene other(64, false, 9, TetOrder::input);
    for (const RayKind kind : all_kinds) {
        const std::uint64_t hash = ray_hash(make_rays(kind, outside().source()));
        EXPECT_EQ(ray_hash(make_rays(kind, other.source())), hash) << name_of(kind);
        const bool is_drawn = kind != RayKind::primary && kind != RayKind::shadow;
        EXPECT_EQ(ray_hash(make_rays(kind, outside().source(1))) != hash, is_drawn) << name_of(kind);
    }
}

TEST(RaySet, is_a_multiple_of_a_tile_s_width_and_only_its_last_ray_repeats)
{
    const GivenScene odd(33);
    for (const RayKind kind : all_kinds) {
        const RaySet set = make_rays(kind, odd.source());
        ASSERT_GT(set.rays.size(), 100u) << name_of(kind);
        EXPECT_EQ(set.rays.size() % TILE_WIDTH, 0u);
        std::set<std::uint32_t> pixels;
        for (const GivenRay& ray : set.rays)
            pixels.insert(ray.pixel);
        EXPECT_LT(set.rays.size() - pixels.size(), TILE_WIDTH);
        EXPECT_EQ(std::count(set.rays.begin(), set.rays.end(), set.rays.back()),
                  static_cast<std::ptrdiff_t>(1 + set.rays.size() - pixels.size()));
        EXPECT_LT(*pixels.rbegin(), 33u * 33);
    }
}

TEST(RaySet, only_shadow_and_ao_end_and_take_any_hit)
{
    for (const RayKind kind : all_kinds) {
        const RaySet set = make_rays(kind, outside().source());
        EXPECT_EQ(set.any_hit, kind == RayKind::shadow || kind == RayKind::ao);
        for (const GivenRay& ray : set.rays)
            ASSERT_EQ(ray.end < 100.0F, set.any_hit) << name_of(kind);
    }
}

TEST(RaySet, pixels_that_miss_make_no_secondary_ray)
{
    GivenScene given;
    for (Hit& hit : given.hits)
        hit = {NO_HIT, NO_TET, 0, 0, 0, 0};
    for (const RayKind kind : secondary_kinds)
        EXPECT_TRUE(make_rays(kind, given.source()).rays.empty());
    given.hits.resize(7);
    EXPECT_THROW((void)make_rays(RayKind::ao, given.source()), Error);
}

TEST(RaySet, hits_of_another_scene_are_refused)
{
    GivenScene given;
    const auto first = std::find_if(given.hits.begin(), given.hits.end(),
                                    [&](const Hit& hit) { return hit.face_id < given.scene.mesh.triangles.size(); });
    ASSERT_NE(first, given.hits.end());
    first->tet = first->tet == 0 ? 5000 : 0;
    EXPECT_THROW((void)make_rays(RayKind::diffuse, given.source()), Error);
    first->tet = given.packed.tet_count;
    EXPECT_THROW((void)make_rays(RayKind::diffuse, given.source()), Error);
}

TEST(RaySet, coordinates_are_such_that_no_product_is_denormal)
{
    for (const RayKind kind : all_kinds)
        for (const GivenRay& ray : make_rays(kind, outside().source()).rays)
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_EQ(ray.origin[axis], snap_to_grid(ray.origin[axis]));
                ASSERT_TRUE(ray.direction[axis] == 0 || std::abs(ray.direction[axis]) >= 0x1p-20F);
            }
}

TEST(RaySet, secondary_rays_start_on_their_face_and_go_to_the_viewer_s_side)
{
    const Scene& scene = outside().scene;
    for (const RayKind kind : secondary_kinds)
        for (const GivenRay& ray : make_rays(kind, outside().source()).rays) {
            ASSERT_EQ(tet_of_start(scene, ray).faces[half_face_index(ray.half_face)], ray.triangle);
            const Double3 normal = inward_normal(scene, ray.half_face);
            const Double3 corner = to_double(face_and_apex(scene, ray.half_face)[0]);
            // Each coordinate is rounded by at most half a unit in the last place of numbers below 1: 2^-25 each.
            ASSERT_LE(std::abs(dot(normal, to_double(ray.origin) - corner)), 0x1p-25 * std::sqrt(3.0));
            ASSERT_GE(dot(normal, normalized(to_double(ray.direction))), min_sine);
            ASSERT_GT(dot(normal, to_double(outside().job.view.origin) - corner), 0) << "seen by the camera";
        }
}

TEST(RaySet, shadow_rays_end_at_the_light)
{
    const Double3 light = to_double(light_of(outside().scene.domain, outside().job.view.origin));
    EXPECT_TRUE(outside().scene.domain.contains(to_float(light)));
    const RaySet set = make_rays(RayKind::shadow, outside().source());
    ASSERT_GT(set.rays.size(), 100u);
    for (const GivenRay& ray : set.rays) {
        const Double3 end = to_double(ray.origin) + to_double(ray.direction) * static_cast<double>(ray.end);
        ASSERT_LE(length(end - light), 0x1p-20 * 2) << "the dropped components, and roundings of 2^-24";
    }
}

TEST(RaySet, the_light_is_in_the_domain_and_35_to_70_degrees_from_the_camera)
{
    const Domain& domain = outside().scene.domain;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const Double3 camera = random_direction({3, 0, i, 0}); // far away: 100 domain units
        const Float3 light = light_of(domain, to_float(camera * 100));
        EXPECT_TRUE(domain.contains(light));
        const Double3 centre = (to_double(domain.low()) + to_double(domain.high())) * 0.5;
        const double cosine = dot(camera, normalized(to_double(light) - centre));
        EXPECT_GT(cosine, 1 / 3.0 - 0.02);            // the camera on a diagonal
        EXPECT_LT(cosine, std::sqrt(2 / 3.0) + 0.02); // on the middle of an edge
    }
}

namespace {

// Means of the cosine between direction and normal, and of its square.
struct CosineMeans {
    double first = 0, second = 0;
};

template <class DirectionOf>
CosineMeans cosine_means(const RaySet& set, const DirectionOf& direction_of)
{
    CosineMeans means;
    for (const GivenRay& ray : set.rays) {
        const double cosine = dot(inward_normal(outside().scene, ray.half_face), direction_of(ray));
        means.first += cosine / static_cast<double>(set.rays.size());
        means.second += cosine * cosine / static_cast<double>(set.rays.size());
    }
    return means;
}

} // namespace

TEST(RaySet, ao_and_diffuse_are_cosine_distributed)
{
    // Of a cosine-distributed direction the cosine has mean 2/3 and variance 1/18, its square 1/2 and 1/12; four
    // standard deviations of the mean. The flattest directions, left out, are 2^-12 of all.
    for (const RayKind kind : {RayKind::ao, RayKind::diffuse}) {
        const RaySet set = make_rays(kind, outside().source());
        const double count = static_cast<double>(set.rays.size());
        ASSERT_GT(count, 600);
        const double first_bound = 4 * std::sqrt(1.0 / 18 / count), second_bound = 4 * std::sqrt(1.0 / 12 / count);
        const CosineMeans means =
            cosine_means(set, [](const GivenRay& ray) { return normalized(to_double(ray.direction)); });
        EXPECT_NEAR(means.first, 2.0 / 3, first_bound);
        EXPECT_NEAR(means.second, 0.5, second_bound);

        const CosineMeans uniform = cosine_means(set, [&](const GivenRay& ray) { // on the hemisphere: 1/2 and 1/3
            const Double3 d = random_direction({7, 0, ray.pixel, 0});
            return dot(d, inward_normal(outside().scene, ray.half_face)) < 0 ? d * -1 : d;
        });
        EXPECT_GT(std::abs(uniform.first - 2.0 / 3), first_bound);
        EXPECT_GT(std::abs(uniform.second - 0.5), second_bound);
    }
}

namespace {

// Length of a line in the domain.
double chord(const Domain& domain, Double3 origin, Double3 direction)
{
    double from = -HUGE_VAL, to = HUGE_VAL;
    const Double3 low = to_double(domain.low()), high = to_double(domain.high());
    const auto clip = [&](double o, double d, double l, double h) {
        if (d == 0) return;
        from = std::max(from, ((d > 0 ? l : h) - o) / d);
        to = std::min(to, ((d > 0 ? h : l) - o) / d);
    };
    clip(origin.x, direction.x, low.x, high.x);
    clip(origin.y, direction.y, low.y, high.y);
    clip(origin.z, direction.z, low.z, high.z);
    return std::max(0.0, to - from) * length(direction);
}

} // namespace

TEST(RaySet, random_rays_are_uniform_chords_of_the_domain)
{
    const Domain& domain = outside().scene.domain;
    const Double3 size = to_double(domain.high()) - to_double(domain.low());
    const double volume = size.x * size.y * size.z;
    const double surface = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double expected = 4 * volume / surface; // the mean chord of isotropic uniform lines (Cauchy)
    const RaySet set = make_rays(RayKind::random, outside().source());
    const double count = static_cast<double>(set.rays.size());
    double sum = 0, squares = 0, biased = 0;
    for (const GivenRay& ray : set.rays) {
        EXPECT_FALSE(domain.contains(ray.origin));
        EXPECT_EQ(ray.half_face, NO_HALF_FACE);
        const double length_inside = chord(domain, to_double(ray.origin), to_double(ray.direction));
        ASSERT_GT(length_inside, 0);
        sum += length_inside;
        squares += length_inside * length_inside;
        biased += chord(domain, (to_double(domain.low()) + to_double(domain.high())) * 0.5, to_double(ray.direction));
    }
    EXPECT_EQ(set.rays.size(), 64u * 64);
    const double bound = 4 * std::sqrt((squares / count - sum / count * sum / count) / count);
    EXPECT_NEAR(sum / count, expected, bound);
    EXPECT_GT(std::abs(biased / count - expected), bound) << "chords through the centre are longer";
}

TEST(RaySet, primary_rays_find_what_the_view_s_own_find)
{
    for (const bool inside : {false, true}) {
        const GivenScene given(48, inside);
        EXPECT_EQ(given.start_tet != NO_TET, inside);
        const RaySet set = make_rays(RayKind::primary, given.source());
        const auto answers = given.answers(set);
        for (std::size_t i = 0; i < answers.size(); ++i)
            ASSERT_EQ(answers[i], given.hits[set.rays[i].pixel]) << "inside: " << inside << ", ray " << i;
    }
}

TEST(RaySet, walks_from_surfaces_are_never_lost_and_never_hit_where_they_start)
{
    for (const bool inside : {false, true}) {
        const GivenScene given(96, inside);
        for (const RayKind kind : secondary_kinds) {
            const RaySet set = make_rays(kind, given.source());
            const auto answers = given.answers(set);
            for (std::size_t i = 0; i < answers.size(); ++i) {
                ASSERT_NE(answers[i].face_id, LOST) << name_of(kind) << ", ray " << i;
                ASSERT_NE(answers[i].face_id, set.rays[i].triangle) << name_of(kind) << ", ray " << i;
            }
        }
    }
}

namespace {

// A ray as flat as rays may be, or somewhat steeper, from both sides of every triangle: from its corners, its edges and
// next to them.
RaySet flat_rays_from_edges(const Scene& scene)
{
    Random random(11);
    RaySet set;
    for (std::uint32_t tet = 0; tet < scene.tets.tets.size(); ++tet)
        for (const std::uint32_t triangle : scene.tets.tets[tet].faces) {
            if (triangle == FREE_FACE) continue;
            for (const auto [u, v] :
                 {std::array{0.0F, 0.0F}, {1.0F, 0.0F}, {0.5F, 0.5F}, {0.25F, 0.0F}, {0.0F, 1e-6F}}) {
                const RayStart start = ray_start(scene, {triangle, tet, 1, u, v, 1});
                const Double3 flat = normalized(cross(start.inward, random_direction({1, tet, triangle, 0})));
                const double rise = (random.below(2) == 0 ? 1.01 : 8.0) * min_sine;
                const Float3 direction = to_float(flat + start.inward * rise);
                EXPECT_TRUE(enters(start, direction)) << "tet " << tet;
                EXPECT_FALSE(enters(start, to_float(flat - start.inward * rise)));
                EXPECT_FALSE(enters(start, to_float(flat + start.inward * (0.99 * min_sine))));
                set.rays.push_back({start.origin, direction, NO_END, start.half_face, triangle, 0});
            }
        }
    set.rays.resize(set.rays.size() / TILE_WIDTH * TILE_WIDTH);
    return set;
}

} // namespace

TEST(RayStart, flat_rays_from_corners_and_edges_walk_into_their_tet)
{
    const RaySet set = flat_rays_from_edges(outside().scene);
    ASSERT_GT(set.rays.size(), 1000u);
    const auto answers = outside().answers(set);
    for (std::size_t i = 0; i < answers.size(); ++i) {
        ASSERT_NE(answers[i].face_id, LOST) << "ray " << i;
        ASSERT_NE(answers[i].face_id, set.rays[i].triangle) << "ray " << i;
    }
}

TEST(RayStart, a_point_at_an_edge_moves_inside_by_the_margin_and_no_other_moves)
{
    const Scene& scene = outside().scene;
    const auto occlusive = [](const Tet& tet) {
        return std::find_if(tet.faces.begin(), tet.faces.end(), [](auto face) { return face != FREE_FACE; });
    };
    const auto tet = std::find_if(scene.tets.tets.begin(), scene.tets.tets.end(),
                                  [&](const auto& each) { return occlusive(each) != each.faces.end(); });
    const auto index = static_cast<std::uint32_t>(tet - scene.tets.tets.begin());
    const std::uint32_t triangle = *occlusive(*tet);
    const auto& [a, b, c] = scene.mesh.triangles[triangle];
    const auto vertex = [&](std::uint32_t i) { return to_double(scene.mesh.vertices[i]); };
    const Double3 on_edge = (vertex(a) + vertex(b)) * 0.5;
    const Double3 along = normalized(vertex(b) - vertex(a));
    const auto off_edge = [&](Float3 point) { return length(cross(to_double(point) - on_edge, along)); };
    const RayStart moved = ray_start(scene, {triangle, index, 1, 0.5F, 0, 1});
    EXPECT_NEAR(off_edge(moved.origin), edge_margin, 0x1p-23);
    const RayStart kept = ray_start(scene, {triangle, index, 1, 0.25F, 0.25F, 1});
    const Double3 point = vertex(a) * 0.5 + vertex(b) * 0.25 + vertex(c) * 0.25;
    EXPECT_LE(length(to_double(kept.origin) - point), 0x1p-24);
}
