// Signs of project: in each tet no face holds the ray, or one to enter and one to leave by.
#include "tests/support/project_on_grids.h"
#include "tests/support/project_without_ties.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Faces of a tet that hold the ray: how many a ray enters by, and leaves by.
struct Held {
    int entered = 0, left = 0;
};
template <class Side>
Held faces_that_hold(const TetMesh& mesh, const Tet& tet, const Side& side)
{
    Held held;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto v = [&](std::uint32_t i) { return mesh.vertices[tet.vertices[right::corner(face, i)]]; };
        const float ab = side(v(0), v(1)), bc = side(v(1), v(2)), ca = side(v(2), v(0));
        held.entered += ab > 0 && bc > 0 && ca > 0;
        held.left += ab < 0 && bc < 0 && ca < 0;
    }
    return held;
}

/// Tets of the grid in which a ray does not have either no face, or one to enter and one to leave by.
template <class Side>
int torn_tets(const Grid& grid, const Side& side)
{
    int torn = 0;
    for (const Tet& tet : grid.scene.tets.tets) {
        const Held held = faces_that_hold(grid.scene.tets, tet, side);
        torn += held.entered != held.left || held.entered > 1;
    }
    return torn;
}

} // namespace

TEST(ProjectSigns, the_grids_are_meshes_without_a_defect)
{
    for (const auto& grid : grids()) {
        const auto defect = find_defect(grid->scene.tets, grid->scene.mesh.triangles.size());
        EXPECT_FALSE(defect.has_value()) << grid->name << ": " << (defect ? defect->what : "");
    }
}

TEST(ProjectSigns, every_tet_has_no_face_that_holds_the_ray_or_one_to_enter_and_one_to_leave_by)
{
    Random random(60);
    for (const auto& grid : grids())
        for (int i = 0; i < 20; ++i) {
            const Line line = line_through(*grid, special_point(*grid, random), random);
            const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
            const auto side = [&](Float3 a, Float3 b) {
                return right::side_at_entry(ray, right::to_vec3(a), right::to_vec3(b));
            };
            ASSERT_EQ(torn_tets(*grid, side), 0) << grid->name << ", ray " << i;
        }
}

TEST(ProjectSigns, without_the_rule_for_ties_tets_are_torn)
{
    Random random(60); // the same rays
    for (const auto& grid : grids()) {
        int torn = 0;
        for (int i = 0; i < 20; ++i) {
            const Line line = line_through(*grid, special_point(*grid, random), random);
            const auto ray =
                without_ties::make_ray(without_ties::to_vec3(line.origin), without_ties::to_vec3(line.direction));
            torn += torn_tets(*grid, [&](Float3 a, Float3 b) {
                return without_ties::side_at_entry(ray, without_ties::to_vec3(a), without_ties::to_vec3(b));
            });
        }
        EXPECT_GT(torn, 0) << grid->name;
    }
}

TEST(ProjectSigns, each_level_of_a_sign_decides_some)
{
    Random random(61);
    decided = {};
    for (const auto& grid : grids())
        for (int i = 0; i < 1500; ++i) {
            const Line line = from_outside(*grid, line_through(*grid, special_point(*grid, random), random));
            (void)traced(*grid, line, NO_TET);
        }
    for (const std::uint64_t count : decided)
        EXPECT_GT(count, 0u);
    RecordProperty("by_products", std::to_string(decided[0]));
    RecordProperty("by_what_they_lost", std::to_string(decided[1]));
    RecordProperty("by_rule_for_ties", std::to_string(decided[2]));
}
