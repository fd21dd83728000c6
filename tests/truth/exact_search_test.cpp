#include "bench/truth/exact_search.h"

#include "core/base/exact.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/near_misses.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct BruteForce {
    std::uint32_t first = NO_HIT; ///< what the exact ray meets first
    bool is_near_an_edge = false; ///< some edge is within the radius of the ray's line
};

double distance(const ExactRay& ray, Double3 a, Double3 b)
{
    const Double3 way = normalized(to_double(ray.direction));
    const Double3 p = a - to_double(ray.origin), pq = b - a;
    const Double3 across = p - way * dot(p, way), along = pq - way * dot(pq, way);
    const double square = dot(along, along);
    const double s = square > 0 ? std::clamp(-dot(across, along) / square, 0.0, 1.0) : 0;
    return length(across + along * s);
}

BruteForce brute_force(const TriangleMesh& mesh, const ExactRay& ray, const RayPart& part, double radius)
{
    BruteForce found;
    double t = HUGE_VAL;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Float3 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
        for (const auto& [from, to] : {std::pair{p, q}, {q, r}, {r, p}})
            found.is_near_an_edge = found.is_near_an_edge || distance(ray, to_double(from), to_double(to)) <= radius;
        const auto crossing = cross_exactly(ray.origin, ray.direction, p, q, r);
        if (i == part.start || !crossing.met || crossing.t > static_cast<double>(part.end) || crossing.t >= t) continue;
        t = crossing.t;
        found.first = i;
    }
    return found;
}

} // namespace

TEST(ExactSearch, finds_what_brute_force_finds_and_says_where_that_is_not_clear)
{
    for (const auto& [name, scene] : make_hard_scenes()) {
        const ExactSearch search(scene.mesh);
        const NearMisses rays(scene.mesh);
        int clear = 0, near = 0, unclear = 0;
        for (std::uint32_t i = 0; i < 600; ++i) {
            const ExactRay ray = rays.ray(i);
            const double radius = tie_bound(ray.origin);
            const BruteForce expected = brute_force(scene.mesh, ray, {}, 2 * radius); // margins are generous
            const FirstHit first = search.first(ray, {}, radius);
            ASSERT_TRUE(!first.is_clear || first.face == expected.first) << name << ", ray " << i;
            unclear += !first.is_clear && !expected.is_near_an_edge; // past a sharp corner, near both its edges' lines
            clear += first.is_clear;
            near += !first.is_clear;
        }
        EXPECT_GT(clear, 50) << name;
        EXPECT_GT(near, 50) << name;
        EXPECT_LT(unclear, 20) << name;
    }
}

TEST(ExactSearch, gathers_all_that_lies_within_the_radius)
{
    for (const auto& [name, scene] : make_hard_scenes()) {
        const ExactSearch search(scene.mesh);
        const NearMisses rays(scene.mesh);
        std::size_t gathered = 0;
        for (std::uint32_t i = 0; i < 200; ++i) {
            const ExactRay ray = rays.ray(i);
            const double radius = 4 * tie_bound(ray.origin);
            const auto within = search.within(ray, {}, radius);
            gathered += within.size();
            for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
                const TriangleMesh one{scene.mesh.vertices, {scene.mesh.triangles[t]}};
                const BruteForce alone = brute_force(one, ray, {}, radius);
                if (alone.first == NO_HIT && !alone.is_near_an_edge) continue;
                EXPECT_TRUE(std::ranges::binary_search(within, t)) << name << ", ray " << i << ", triangle " << t;
            }
        }
        EXPECT_GT(gathered, 200u) << name;
    }
}

TEST(ExactSearch, heeds_where_a_ray_starts_and_ends)
{
    const TriangleMesh sheets{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -1, -1}, {1, -1, -1}, {0, 1, -1}},
                              {{0, 1, 2}, {3, 4, 5}}};
    const ExactSearch search(sheets);
    const auto first = [&](float z, const RayPart& part) { return search.first({{0, 0, z}, {0, 0, -1}}, part, 1e-6); };
    EXPECT_EQ(first(1, {}).face, 0u);
    EXPECT_EQ(first(0, {.start = 0}).face, 1u);
    EXPECT_EQ(first(-0.5f, {}).face, 1u);
    EXPECT_EQ(first(-2, {}).face, NO_HIT);
    EXPECT_EQ(first(1, {.end = 0.5f}).face, NO_HIT);
    EXPECT_TRUE(first(1, {.end = 0.5f}).is_clear);
    EXPECT_FALSE(first(0x1p-21f, {}).is_clear) << "it starts within the radius of a triangle";
    EXPECT_FALSE(first(1, {.end = 1 + 0x1p-21f}).is_clear) << "it ends there";
}

TEST(ExactSearch, is_not_clear_if_another_triangle_is_first_next_to_the_ray)
{
    // On the far side of the slope along the ray, and on the near side at half of the radius to the left.
    constexpr float radius = 0x1p-18f;
    const TriangleMesh mesh{{{-1, -1, -1},
                             {1, -1, 1},
                             {0, 2, 0},
                             {-radius / 2, -1, -radius / 4},
                             {-radius / 2, 1, -radius / 4},
                             {-1, 0, 0}},
                            {{0, 1, 2}, {3, 4, 5}}};
    const ExactRay ray{{0, 0, 1}, {0, 0, -1}};
    EXPECT_FALSE(ExactSearch(mesh).first(ray, {}, double{radius}).is_clear);
    EXPECT_TRUE(ExactSearch(mesh).first(ray, {}, double{radius} / 4).is_clear);
}

TEST(ExactSearch, of_triangles_in_one_place_and_of_none_ends)
{
    TriangleMesh heap{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}};
    EXPECT_EQ(ExactSearch(heap).first({{0, 0, 1}, {0, 0, -1}}, {}, 1e-6).face, NO_HIT);
    heap.triangles.assign(1000, {0, 1, 2});
    const ExactSearch search(heap);
    EXPECT_FALSE(search.first({{0, 0, 1}, {0, 0, -1}}, {}, 1e-6).is_clear) << "which one is first?";
    EXPECT_EQ(search.within({{0, 0, 1}, {0, 0, -1}}, {}, 1e-6).size(), 1000u);
}
