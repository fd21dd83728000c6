// The oracle of task absorb: right answers are accepted, those of exact rays are within their bound, falsified ones are
// caught.
#include "bench/truth/absorption.h"

#include "bench/truth/hit_checks.h"
#include "bench/truth/tally.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Hard rays; for maria only the chords, in general position.
RaySet rays_for(Method method, const Scene& scene, std::size_t count)
{
    RaySet set = hard_ray_set(scene, 0, count);
    if (method == Method::project) return set;
    const HardRays rays(scene);
    for (std::size_t i = 0; i < count; ++i)
        set.rays[i] = rays.ray(i * hard_kinds);
    return set;
}

/// What exact rays have, without any walk, in double precision.
struct ExactLight {
    double light = 0, passed = 1; ///< of the whole line
    double bound = 0;             ///< how far a right answer may be from either
};

/// A length that is off by d changes light and transmittance by no more than what passes so far times ln 2 times
/// density times d. A transmittance is off by 1.1 units, twice per tet.
ExactLight exact_light(const Scene& scene, const CrossedScene& tets, const GivenRay& ray)
{
    auto chords = exact_chords(scene, ray);
    std::ranges::sort(chords, {}, &ExactChord::begin);
    ExactLight all;
    double off = 0;
    for (const ExactChord& chord : chords) {
        const Medium medium = medium_of(tets.packed().packed_of_mesh[chord.tet]);
        const double density = std::log(2.0) * medium.density / 16;
        const double left = all.passed * std::exp(-density * chord.share.length);
        all.light += medium.value / 256.0 * (all.passed - left);
        all.bound += all.passed * std::exp(off) * density * chord.share.bound + 2.2 * 0x1p-24;
        off += density * chord.share.bound;
        all.passed = left;
    }
    return all;
}

bool is_accepted(const CrossedScene& tets, const RaySet& set, std::size_t ray, const Absorbed& answer,
                 const CrossedTets& walk)
{
    RaySet one = set;
    one.rays = {set.rays[ray]};
    return tets.judged(one, {as_hit(answer)}, {walk}).clean();
}

} // namespace

TEST(Absorption, of_hard_rays_is_right_for_each_kernel_and_the_same_on_all_layouts)
{
    RayTotals totals;
    for (const auto& [name, scene] : make_hard_scenes()) {
        std::map<Method, std::vector<Hit>> of_method;
        for (const KernelId& kernel : kernels_of(Task::absorb)) {
            const CrossedScene tets(scene, kernel);
            const RaySet set = rays_for(kernel.method, scene, 3600);
            const std::vector<Hit> answers = tets.answers(set);
            const Verdicts verdicts = tets.judged(set, answers, tets.walks(set));
            EXPECT_TRUE(verdicts.clean())
                << name << ' ' << name_of(kernel) << ": " << (verdicts.clean() ? "" : verdicts.first_wrong->reason);
            const RayTotals own = count_absorbed(answers);
            EXPECT_LT(own.absorbed, own.hits) << name;
            totals.add(own);
            auto& first = of_method.try_emplace(kernel.method, answers).first->second;
            for (std::size_t i = 0; i < answers.size(); ++i)
                EXPECT_EQ(absorbed_of(answers[i]), absorbed_of(first[i])) << name << ' ' << name_of(kernel) << i;
        }
    }
    EXPECT_GT(totals.absorbed, totals.hits / 16);
}

TEST(Absorption, of_exact_rays_is_the_same_within_its_bound)
{
    const Scene scene = make_cubes(3);
    for (const KernelId& kernel : kernels_of(Task::absorb)) {
        const CrossedScene tets(scene, kernel);
        const RaySet set = rays_for(Method::maria, scene, 3600);
        std::size_t sharp = 0, ended = 0;
        for (std::size_t i = 0; const Hit& hit : tets.answers(set)) {
            const Absorbed answer = absorbed_of(hit);
            const ExactLight exact = exact_light(scene, tets, set.rays[i]);
            const bool is_ended = answer.transmittance < MIN_TRANSMITTANCE;
            const double passed = share_passed(answer.transmittance), rest = is_ended ? passed : 0;
            EXPECT_LE(share_of_light(answer.light), exact.light + exact.bound) << name_of(kernel) << ' ' << i;
            EXPECT_GE(share_of_light(answer.light), exact.light - exact.bound - rest) << name_of(kernel) << ' ' << i;
            EXPECT_LE(exact.passed, passed + exact.bound) << name_of(kernel) << ' ' << i;
            EXPECT_GE(exact.passed, passed - exact.bound - rest) << name_of(kernel) << ' ' << i;
            sharp += exact.bound < 0x1p-10 ? 1 : 0;
            ended += is_ended ? 1 : 0;
            ++i;
        }
        EXPECT_GT(sharp, set.rays.size() / 2) << "the bound shows nothing";
        EXPECT_GT(ended, set.rays.size() / 16);
    }
}

TEST(Absorption, falsified_answers_and_walks_are_caught)
{
    const Scene scene = make_cubes(5);
    const CrossedScene tets(scene, Method::project, Layout::half32, Task::absorb);
    const RaySet set = rays_for(Method::maria, scene, 480);
    const std::vector<Hit> answers = tets.answers(set);
    const auto walks = tets.walks(set);
    std::size_t ended = 0;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const CrossedTets& walk = walks[i];
        const Absorbed right = absorbed_of(answers[i]);
        ASSERT_TRUE(is_accepted(tets, set, i, right, walk)) << i;
        for (const auto word : {&Absorbed::first, &Absorbed::last, &Absorbed::light, &Absorbed::hash,
                                &Absorbed::transmittance, &Absorbed::crossings})
            for (const std::uint32_t bit : {1u, 1u << 9, 1u << 20}) {
                Absorbed other = right;
                other.*word ^= bit;
                EXPECT_FALSE(is_accepted(tets, set, i, other, walk)) << i;
            }
        const auto expect_caught = [&](const CrossedTets& wrong, const char* mistake, std::size_t k) {
            if (wrong.tets.empty()) return;
            EXPECT_FALSE(is_accepted(tets, set, i, absorption_of(wrong), wrong)) << i << ' ' << mistake << ' ' << k;
        };
        if (walk.tets.size() < 2) continue;
        const bool is_ended = right.transmittance < MIN_TRANSMITTANCE;
        ended += is_ended ? 1 : 0;
        // What is shorter than a few bounds may be left out.
        const auto short_length = static_cast<std::uint32_t>(64 * tie_bound(set.rays[i].origin) * 0x1p28);
        for (std::size_t k = 0; k < walk.tets.size(); ++k) {
            if (walk.places[k + 1] < walk.places[k] + short_length) continue;
            CrossedTets wrong = walk;
            drop(wrong, k);
            expect_caught(wrong, "left out", k);
            wrong = walk;
            wrong.tets[k] = other_neighbour(scene, tets, walk, walk.tets[k]);
            if (wrong.tets[k] != NO_TET) expect_caught(wrong, "exchanged", k);
            wrong = walk;
            wrong.places[k + 1] -= (walk.places[k + 1] - walk.places[k]) / 2;
            expect_caught(wrong, "left too early", k);
        }
        CrossedTets longer = walk;
        longer.tets.push_back(other_neighbour(scene, tets, walk, walk.tets.back()));
        longer.places.push_back(walk.places.back() + short_length);
        if (is_ended && longer.tets.back() != NO_TET) expect_caught(longer, "goes on", walk.tets.size());
    }
    EXPECT_GT(ended, 50u);
}
