// The oracle of task segments: right walks are accepted, falsified ones are caught.
#include "core/base/exact.h"
#include "scenes/procedural.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The tets in which a ray is somewhere deeper than some bounds, by brute force over all tets and places along the ray:
/// shares nothing with the oracle.
class DeepTets {
public:
    DeepTets(const Scene& scene, const GivenRay& ray)
    {
        const Double3 origin = to_double(ray.origin), along = normalized(to_double(ray.direction));
        for (std::uint32_t tet = 0; tet < scene.tets.tets.size(); ++tet)
            if (depth(scene.tets, tet, origin, along) > 1.5 * tie_bound(ray.origin)) tets_.insert(tet);
    }
    [[nodiscard]] bool are_all_in(const CrossedTets& walk, const std::vector<std::uint32_t>& mesh_of_packed) const
    {
        std::set<std::uint32_t> own;
        for (const std::uint32_t tet : walk.tets)
            own.insert(mesh_of_packed.at(tet));
        return std::ranges::includes(own, tets_);
    }

private:
    static double depth(const TetMesh& mesh, std::uint32_t tet, Double3 origin, Double3 along)
    {
        std::array<Double3, 4> corners{};
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = to_double(mesh.vertices[mesh.tets[tet].vertices[i]]) - origin;
        std::array<Double3, 4> normals{};
        double from = 0, to = HUGE_VAL;
        for (std::size_t side = 0; side < 4; ++side) {
            const Double3 a = corners[(side + 1) % 4], b = corners[(side + 2) % 4], c = corners[(side + 3) % 4];
            normals[side] = normalized(cross(b - a, c - a));
            if (dot(normals[side], corners[side] - a) < 0) normals[side] = normals[side] * -1;
            const double at = -dot(normals[side], a), slope = dot(normals[side], along);
            if (slope > 0) from = std::max(from, -at / slope);
            if (slope < 0) to = std::min(to, -at / slope);
            if (slope == 0 && at < 0) return 0;
        }
        double deepest = 0;
        for (int i = 1; i < 32 && from < to; ++i) {
            const Double3 place = along * (from + (to - from) * i / 32);
            double least = HUGE_VAL;
            for (std::size_t side = 0; side < 4; ++side)
                least = std::min(least, dot(normals[side], place - corners[(side + 1) % 4]));
            deepest = std::max(deepest, least);
        }
        return deepest;
    }

    std::set<std::uint32_t> tets_;
};

enum class Mistake { left_out, twice, exchanged, appended, ends_early, begins_late, leaves_by_its_entry };
constexpr std::array<const char*, 7> mistakes = {"left out",   "twice",       "exchanged",          "appended",
                                                 "ends early", "begins late", "leaves by its entry"};

/// The walk with a mistake at a tet; empty if it cannot be made there.
std::optional<CrossedTets> falsified(const Scene& scene, const CrossedScene& tets, CrossedTets walk, Mistake mistake,
                                     std::size_t i)
{
    const auto place = static_cast<std::ptrdiff_t>(i);
    switch (mistake) {
    case Mistake::left_out: drop(walk, i); break;
    case Mistake::twice:
        walk.tets.insert(walk.tets.begin() + place, walk.tets[i]);
        walk.places.insert(walk.places.begin() + place, walk.places[i]);
        break;
    case Mistake::exchanged: {
        const auto other = other_neighbour(scene, tets, walk, walk.tets[i]);
        if (other == NO_TET) return std::nullopt;
        walk.tets[i] = other;
        break;
    }
    case Mistake::appended: {
        const auto other = other_neighbour(scene, tets, walk, walk.tets.back());
        if (other == NO_TET) return std::nullopt;
        walk.tets.push_back(other);
        walk.places.push_back(walk.places.back());
        break;
    }
    case Mistake::ends_early:
        while (walk.tets.size() > i)
            drop(walk, walk.tets.size() - 1);
        break;
    case Mistake::begins_late:
        for (std::size_t k = 0; k <= i; ++k) {
            walk.tets.erase(walk.tets.begin());
            walk.places.erase(walk.places.begin());
        }
        break;
    case Mistake::leaves_by_its_entry:
        if (i + 1 != walk.tets.size() || walk.places[i + 1] < walk.places[i] + (1u << 18u)) return std::nullopt;
        walk.places.back() = walk.places[i];
        break;
    }
    return walk.tets.empty() ? std::nullopt : std::optional(walk);
}

bool is_accepted(const CrossedScene& tets, const RaySet& one, const Segments& answer, const CrossedTets& walk)
{
    return tets.judged(one, {as_hit(answer)}, {walk}).clean();
}

/// Every mistake at every tet of some rays' walks.
void expect_mistakes_caught(const Scene& scene, const std::string& name, std::uint64_t rays)
{
    const CrossedScene tets(scene, Method::project, Layout::tet80);
    const RaySet all = hard_ray_set(scene, 0, rays);
    const auto walks = tets.walks(all);
    std::map<Mistake, std::array<std::size_t, 2>> counts; // made, and caught
    for (std::size_t i = 0; i < all.rays.size(); ++i) {
        if (walks[i].tets.empty()) continue;
        RaySet one = all;
        one.rays = {all.rays[i]};
        const DeepTets deep(scene, all.rays[i]);
        ASSERT_TRUE(deep.are_all_in(walks[i], tets.mesh_of_packed())) << name << ", ray " << i;
        for (const Mistake mistake : {Mistake::left_out, Mistake::twice, Mistake::exchanged, Mistake::appended,
                                      Mistake::ends_early, Mistake::begins_late, Mistake::leaves_by_its_entry})
            for (std::size_t k = 0; k < walks[i].tets.size(); ++k) {
                const auto wrong = falsified(scene, tets, walks[i], mistake, k);
                if (!wrong) continue;
                const bool is_caught = !is_accepted(tets, one, summary_of(*wrong), *wrong);
                const bool may_pass = mistake != Mistake::twice && mistake != Mistake::leaves_by_its_entry &&
                                      deep.are_all_in(*wrong, tets.mesh_of_packed());
                EXPECT_TRUE(is_caught || may_pass)
                    << name << ", ray " << i << ": " << k << " is " << mistakes.at(static_cast<std::size_t>(mistake));
                auto& [made, caught] = counts[mistake];
                ++made;
                caught += is_caught ? 1 : 0;
            }
    }
    for (const auto& [mistake, count] : counts) {
        fmt::print("{}: {}: {} of {} caught\n", name, mistakes.at(static_cast<std::size_t>(mistake)), count[1],
                   count[0]);
        // What is not caught is right, too: most of all, a tet appended at an edge by which the ray leaves the domain.
        EXPECT_GT(static_cast<double>(count[1]), 0.75 * static_cast<double>(count[0])) << name;
    }
}

} // namespace

TEST(Crossings, right_walks_of_hard_rays_are_accepted)
{
    for (const auto& [name, scene] : make_hard_scenes())
        for (const Layout layout : {Layout::tet80, Layout::half32, Layout::tet64}) {
            const CrossedScene tets(scene, Method::project, layout);
            const RaySet set = hard_ray_set(scene, 100'000, 1'800);
            const Verdicts verdicts = tets.judged(set, tets.answers(set), tets.walks(set));
            EXPECT_TRUE(verdicts.clean()) << name << ": " << (verdicts.clean() ? "" : verdicts.first_wrong->reason);
            EXPECT_GT(verdicts.ties, 0u) << name;
        }
}

TEST(Crossings, falsified_walks_are_caught)
{
    auto scenes = make_hard_scenes();
    expect_mistakes_caught(scenes[1].scene, scenes[1].name, 160);
    expect_mistakes_caught(scenes[0].scene, scenes[0].name, 48);
}

TEST(Crossings, a_changed_bit_of_an_answer_or_a_moved_place_is_caught)
{
    const Scene scene = make_cubes(5);
    const CrossedScene tets(scene, Method::project, Layout::tet80);
    const RaySet all = hard_ray_set(scene, 0, 240);
    const auto walks = tets.walks(all);
    const auto answers = tets.answers(all);
    std::size_t moved = 0, caught = 0;
    for (std::size_t i = 0; i < all.rays.size(); ++i) {
        RaySet one = all;
        one.rays = {all.rays[i]};
        const Segments right = segments_of(answers[i]);
        ASSERT_TRUE(is_accepted(tets, one, right, walks[i])) << i;
        for (const auto word : {&Segments::first, &Segments::last, &Segments::length, &Segments::hash,
                                &Segments::reversed, &Segments::crossings})
            for (const std::uint32_t bit : {1u, 1u << 9, 1u << 20}) {
                Segments other = right;
                other.*word ^= bit;
                EXPECT_FALSE(is_accepted(tets, one, other, walks[i])) << i;
            }
        const auto far = static_cast<std::uint32_t>(tie_bound(all.rays[i].origin) * 64 * (1u << LENGTH_BITS));
        for (std::size_t k = 0; k < walks[i].places.size(); ++k) {
            CrossedTets other = walks[i];
            other.places[k] += far;
            ++moved;
            caught += is_accepted(tets, one, summary_of(other), other) ? 0 : 1;
        }
    }
    // What passes is on faces that the ray meets at less than 1/30, or seen edge-on.
    EXPECT_GT(static_cast<double>(caught), 0.9 * static_cast<double>(moved)) << caught << " of " << moved;
}

TEST(Crossings, the_summary_of_a_walk_counts_what_comes_out_of_order)
{
    const Segments sum = summary_of({{7, 3, 9, 4}, {100, 130, 120, 125, 160}});
    EXPECT_EQ(sum.first, 7u);
    EXPECT_EQ(sum.last, 4u);
    EXPECT_EQ(sum.crossings, 4u);
    EXPECT_EQ(sum.length, 60u);
    EXPECT_EQ(sum.reversed, 2u) << "120 and 125 come before 130";
    EXPECT_NE(sum.hash, summary_of({{3, 7, 9, 4}, {100, 130, 120, 125, 160}}).hash);
    EXPECT_NE(sum.hash, summary_of({{7, 3, 9, 4}, {100, 130, 121, 125, 160}}).hash);
    EXPECT_EQ(summary_of({}), (Segments{NO_HIT, NO_TET, 0, 0, 0, 0}));
}
