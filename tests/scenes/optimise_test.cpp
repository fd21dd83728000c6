// The optimiser as a whole: cheaper, sound, the same surfaces, the same bits.
#include "core/base/error.h"
#include "core/mesh/sides.h"
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
    EXPECT_FALSE(report.out_of_time);
}

TEST(Optimise, gives_the_same_bits_each_time)
{
    const Scene scene = make_cubes(6);
    EXPECT_EQ(optimised(scene.tets, 3).mesh, optimised(scene.tets, 3).mesh);
}

TEST(Optimise, leaves_a_mesh_alone_that_it_cannot_better)
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
    EXPECT_TRUE(result.report.out_of_time);
    expect_same_domain(result.mesh, scene);
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
