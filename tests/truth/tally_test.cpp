// Sums per tet of task tally: as the walks give them, as exact rays give them, and falsified.
#include "bench/truth/tally.h"

#include "core/base/error.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Sums = std::vector<std::uint64_t>;

/// Uniform chords through a scene, in general position.
RaySet chords(const Scene& scene, std::size_t count)
{
    RaySet set = hard_ray_set(scene, 0, count);
    const HardRays rays(scene);
    for (std::size_t i = 0; i < count; ++i)
        set.rays[i] = rays.ray(i * hard_kinds);
    return set;
}

Sums sums_of_walks(const CrossedScene& tets, const RaySet& set)
{
    const std::vector<CrossedTets> walks = tets.walks(set);
    return tally_of_walks(
        walks.size(), tets.packed().tet_count, [&](std::size_t ray) { return walks[ray]; }, 2);
}

bool is_caught(const Sums& tally, const Sums& expected)
{
    try {
        require_sums(tally, expected);
        return false;
    } catch (const Error& error) {
        return error.kind() == ErrorKind::wrong_result;
    }
}

bool has_wrong_total(const Sums& tally, const std::vector<Hit>& answers)
{
    try {
        require_total(tally, answers);
        return false;
    } catch (const Error& error) {
        return error.kind() == ErrorKind::wrong_result;
    }
}

} // namespace

TEST(Tally, of_hard_rays_is_that_of_their_walks_for_any_number_of_threads)
{
    for (const auto& [name, scene] : make_hard_scenes())
        for (const KernelId& kernel : kernels_of(Task::tally)) {
            const CrossedScene tets(scene, kernel);
            const RaySet set = hard_ray_set(scene, 0, 3600);
            const Sums expected = sums_of_walks(tets, set);
            for (const unsigned threads : {1u, 2u, 7u}) {
                const auto session = tets.session(threads);
                const std::vector<Hit> answers = tets.answers(*session, set);
                const Sums tally = session->tally();
                EXPECT_EQ(tally, expected) << name << ' ' << name_of(kernel) << ' ' << name_of(kernel.schedule) << ", "
                                           << threads << " threads";
                EXPECT_FALSE(has_wrong_total(tally, answers)) << name << ' ' << name_of(kernel);
            }
        }
}

TEST(Tally, of_exact_rays_is_the_same_within_its_bound)
{
    const Scene scene = make_cubes(3);
    for (const KernelId& kernel : kernels_of(Task::tally)) {
        const CrossedScene tets(scene, kernel);
        for (const bool are_hard : {false, true}) {
            if (are_hard && kernel.method != Method::project) continue;
            const RaySet set = are_hard ? hard_ray_set(scene, 0, 3600) : chords(scene, 3600);
            const auto session = tets.session(2);
            static_cast<void>(tets.answers(*session, set));
            const Sums tally = session->tally();
            const std::vector<ExactLength> exact = exact_tally(scene, set);
            for (std::size_t tet = 0; tet < tally.size(); ++tet) {
                const ExactLength& own = exact[tets.mesh_of_packed()[tet]];
                EXPECT_NEAR(length_of(tally[tet]), own.length, own.bound) << name_of(kernel) << " tet " << tet;
                if (!are_hard) {
                    EXPECT_LT(own.bound, own.length / 16) << "tet " << tet << ": the bound shows nothing";
                }
            }
        }
    }
}

TEST(Tally, falsified_sums_are_caught)
{
    const Scene scene = make_cubes(3);
    const CrossedScene tets(scene, Method::project, Layout::half32, Task::tally);
    const RaySet set = chords(scene, 7200);
    const auto session = tets.session(2);
    const std::vector<Hit> answers = tets.answers(*session, set);
    const Sums right = session->tally();
    const Sums expected = sums_of_walks(tets, set);
    ASSERT_FALSE(is_caught(right, expected));
    ASSERT_FALSE(has_wrong_total(right, answers));
    ASSERT_GT(right[0], 0u);

    Sums no_carry = right;
    no_carry[0] -= std::uint64_t{1} << 32;
    EXPECT_TRUE(is_caught(no_carry, expected));
    EXPECT_TRUE(has_wrong_total(no_carry, answers));

    RaySet twice = set;
    twice.rays.resize(set.rays.size() + TILE_WIDTH, set.rays.back());
    const auto more = tets.session(2);
    static_cast<void>(tets.answers(*more, twice));
    EXPECT_TRUE(is_caught(more->tally(), expected));
    EXPECT_TRUE(has_wrong_total(more->tally(), answers));

    for (std::uint32_t tet = 0; tet < right.size(); ++tet)
        for (const std::uint32_t across : scene.tets.tets[tets.mesh_of_packed()[tet]].neighbours) {
            if (across == NO_HALF_FACE) continue;
            Sums moved = right;
            moved[tets.packed().packed_of_mesh[half_face_tet(across)]] += std::exchange(moved[tet], 0);
            EXPECT_TRUE(is_caught(moved, expected)) << tet;
            EXPECT_FALSE(has_wrong_total(moved, answers)) << "the total does not show it";
        }
    EXPECT_TRUE(is_caught(Sums(right.size(), 0), expected));
}

TEST(Tally, of_passes_is_that_of_each_or_an_error)
{
    const Scene scene = make_cubes(3);
    const CrossedScene tets(scene, Method::maria, Layout::tet80, Task::tally);
    const RaySet set = chords(scene, 360);
    const auto session = tets.session(2);
    session->set_rays(segment_quads(set, tets.packed()));
    std::vector<Hit> answers(set.rays.size());
    TraceJob job = given_job(set.rays.size(), tets.packed().tet_count + 1, false);
    static_cast<void>(session->trace(job, answers));
    const Sums once = session->tally();
    job.passes = 3;
    static_cast<void>(session->trace(job, answers));
    EXPECT_EQ(session->tally(), once);
    const std::array jobs{job, job};
    EXPECT_THROW(session->launch(jobs), Error) << "one tally per launch";
}
