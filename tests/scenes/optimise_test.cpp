// The optimiser as a whole: cheaper, sound, the same surfaces, the same bits.
#include "core/base/error.h"
#include "core/mesh/entry_grid.h"
#include "scenes/optimise/editable_mesh.h"
#include "scenes/optimise/graded_points.h"
#include "scenes/optimise/optimise.h"
#include "scenes/procedural.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/sound_tets.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

OptimisedTets optimised(const TetMesh& mesh, int effort)
{
    return optimise(mesh, {effort, 0}, {});
}

} // namespace

TEST(Optimise, lowers_the_cost_and_keeps_all_surfaces)
{
    const Scene scene = make_cubes(8);
    double last = 1e9;
    for (const int effort : {0, 1, 2, 3}) {
        const OptimisedTets result = optimised(scene.tets, effort);
        expect_same_domain(result.mesh, scene);
        EXPECT_LE(result.report.cost_after, 1.02 * last) << "more effort should not cost more";
        last = result.report.cost_after;
        const EditableMesh before(scene.tets), after(result.mesh);
        EXPECT_NEAR(result.report.cost_before, 2 * before.cost() / before.boundary_area(), 1e-9);
        EXPECT_NEAR(result.report.cost_after, 2 * after.cost() / after.boundary_area(), 1e-9);
        EXPECT_EQ(effort == 0, result.mesh == scene.tets);
        EXPECT_LT(result.report.cost_after, (effort < 2 ? 1.001 : 0.85) * result.report.cost_before);
    }
}

TEST(Optimise, makes_boundary_faces_that_rounding_cannot_turn_over)
{
    Scene scene = make_cubes(8);
    scene.tets = optimised(scene.tets, 3).mesh;
    EXPECT_EQ(find_weak_side(scene, make_entry_grid(scene.domain, scene.tets)), "");
    std::size_t faces = 0;
    const EntryGrid grid = make_entry_grid(scene.domain, scene.tets);
    for (std::uint32_t side = 0; side < 6; ++side)
        faces += faces_of_side(grid, side).size();
    EXPECT_LT(faces, 6u * 2 * 8 * 8 / 4) << "few faces are left of the sides";
}

TEST(Optimise, keeps_flat_stretched_and_regular_grids_sound)
{
    for (const auto& [name, scene] : make_hard_scenes()) {
        const OptimisedTets result = optimised(scene.tets, 2);
        SCOPED_TRACE(name);
        expect_same_domain(result.mesh, scene);
        EXPECT_LE(result.report.cost_after, result.report.cost_before);
    }
}

TEST(Optimise, reports_gains_that_add_up)
{
    const OptimiserReport report = optimised(make_cubes(6).tets, 3).report;
    double sum = 0;
    for (const OperationCount& operation : report.operations)
        sum += operation.gain;
    EXPECT_NEAR(report.cost_before - report.cost_after, sum, 1e-9);
    EXPECT_EQ(report.end, OptimiserEnd::finished);
}

TEST(Optimise, inserts_vertices_for_several_pieces_unless_effort_is_least)
{
    const TetMesh mesh = make_cubes(8).tets;
    for (const int effort : {1, 2}) {
        OptimiserLimits limits{effort, 0};
        const OptimiserReport one = optimise(mesh, limits, {}).report;
        limits.several_pieces = true;
        const OptimiserReport several = optimise(mesh, limits, {}).report;
        EXPECT_EQ(one.operations.back().done, 0U);
        EXPECT_EQ(several.operations.back().done > 0, effort == 2);
        EXPECT_EQ(several.operations.back().gain > 0, effort == 2);
        EXPECT_EQ(several.cost_after == one.cost_after, effort == 1);
        EXPECT_LT(several.cost_after, several.cost_before);
    }
}

TEST(Optimise, gives_the_same_bits_each_time)
{
    const Scene scene = make_cubes(6);
    EXPECT_EQ(optimised(scene.tets, 3).mesh, optimised(scene.tets, 3).mesh);
}

TEST(Optimise, gives_the_same_bits_for_any_number_of_threads)
{
    const Scene scene = make_cubes(8);
    for (const int effort : {2, 3}) {
        OptimiserLimits limits{effort, 0};
        limits.threads = 1;
        limits.tets_per_region = 400;
        ASSERT_GT(count_faces(scene.tets).reached_tets, 4 * limits.tets_per_region) << "too few for several regions";
        const OptimisedTets alone = optimise(scene.tets, limits, {});
        expect_same_domain(alone.mesh, scene);
        for (const int threads : {2, 3, 8}) {
            limits.threads = threads;
            const OptimisedTets result = optimise(scene.tets, limits, {});
            EXPECT_EQ(result.mesh, alone.mesh) << threads << " threads";
            EXPECT_EQ(result.report.cost_after, alone.report.cost_after);
            EXPECT_EQ(result.report.rounds, alone.report.rounds);
        }
    }
}

TEST(Optimise, leaves_a_mesh_unchanged_that_it_cannot_improve)
{
    TetMesh mesh = make_cubes(4).tets;
    for (int i = 0; i < 50; ++i) {
        OptimisedTets next = optimised(mesh, 3);
        const bool stays = next.report.cost_after == next.report.cost_before;
        EXPECT_EQ(stays, next.mesh == mesh);
        if (stays) return;
        EXPECT_LE(next.report.cost_after, next.report.cost_before);
        mesh = std::move(next.mesh);
    }
    FAIL() << "it never comes to an end";
}

TEST(Optimise, ends_in_time_with_a_sound_mesh)
{
    const Scene scene = make_cubes(12);
    const OptimisedTets result = optimise(scene.tets, {3, 1e-9}, {});
    EXPECT_EQ(result.report.end, OptimiserEnd::out_of_time);
    expect_same_domain(result.mesh, scene);
}

TEST(Optimise, ends_at_its_limit_with_a_sound_mesh_and_its_gain)
{
    const Scene scene = make_cubes(12);
    std::atomic<bool> stop{false};
    int looks = 0;
    const OptimisedTets result = optimise(scene.tets, {3, 0, &stop}, [&](const std::string&, double, const auto&) {
        if (++looks == 8) stop = true; // after some sweeps
    });
    EXPECT_EQ(result.report.end, OptimiserEnd::interrupted);
    EXPECT_EQ(looks, 9) << "it sees that at the next look, and ends";
    expect_same_domain(result.mesh, scene);
    EXPECT_LT(result.report.cost_after, result.report.cost_before);
    EXPECT_GT(result.report.cost_after, optimised(scene.tets, 3).report.cost_after);
}

TEST(Optimise, reports_its_gain_and_a_share_that_approaches_one)
{
    double last = 0;
    std::string detail;
    static_cast<void>(optimise(make_cubes(12).tets, {2, 0},
                               [&](const std::string& stage, double fraction, const std::string& reached) {
                                   EXPECT_EQ(stage, "optimising");
                                   EXPECT_TRUE(fraction >= 0 && fraction <= 1) << fraction;
                                   last = fraction;
                                   detail = reached;
                               }));
    EXPECT_GT(last, 0.5);
    EXPECT_EQ(detail.rfind("round ", 0), 0u) << detail;
}

TEST(Forecast, expects_rounds_to_go_on_as_they_did)
{
    Forecast forecast;
    EXPECT_GT(forecast.left_s(1, 0.5, 0.01, 16), 1) << "the rest of the first round, and more";
    forecast.end_round(8, 1);
    forecast.end_round(12, 0.5);
    forecast.end_round(14, 0.25);
    // Rounds of 8, 4, 2 seconds; the next ones gain 1/8 and 1/16, take 1 and 1/2 second, and then it is enough.
    EXPECT_NEAR(forecast.left_s(14, 0, 0.1, 16), 1.5, 1e-9);
    EXPECT_NEAR(forecast.left_s(14.25, 0.25, 0.1, 16), 1.25, 1e-9);
    EXPECT_NEAR(forecast.left_s(14, 0, 0.1, 0), 1, 1e-9) << "no more rounds are allowed";
}

TEST(GradedPoints, lie_in_the_domain_on_the_grid_and_off_the_mesh)
{
    const Scene scene = make_cubes(8);
    const std::vector<Float3> points = graded_points(scene.mesh, scene.domain);
    EXPECT_GT(points.size(), 50U);
    for (const Float3 p : points) {
        EXPECT_TRUE(scene.domain.contains(p));
        EXPECT_EQ(snap_to_grid(p), p);
        for (const Float3 v : scene.mesh.vertices)
            EXPECT_GT(length(to_double(p) - to_double(v)), 1e-3);
    }
    EXPECT_EQ(points, graded_points(scene.mesh, scene.domain));
}

// Cells are cut once more where a mesh has edges half as long, so a finer mesh has points nearer to its surface.
TEST(GradedPoints, are_denser_where_the_mesh_is_finer)
{
    const auto count = [](std::uint32_t triangles) {
        const TriangleMesh mesh = make_banana(triangles);
        return graded_points(mesh, make_domain(mesh, DomainKind::tight, 8)).size();
    };
    const std::size_t coarse = count(4'000), fine = count(100'000);
    EXPECT_GT(fine, 4 * coarse);
}
