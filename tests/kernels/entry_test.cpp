#include "core/base/exact.h"
#include "scenes/optimise/optimise.h"
#include "scenes/procedural.h"
#include "tests/support/cut_anew.h"
#include "tests/support/maria_kernel.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

using namespace tetrace;
using namespace tetrace::test;
using namespace tetrace::test::maria;

namespace {

struct PackedCubes {
    Scene scene;
    PackedScene packed = pack(scene, Layout::tet96, TetOrder::input);

    explicit PackedCubes(Scene made) : scene(std::move(made)) {}
};
const PackedCubes& box()
{
    static const PackedCubes made(make_cubes(5));
    return made;
}

// With squares that the boundary faces lie across, or that lie inside of one face.
Scene cubes_with_squares(std::uint32_t divisions)
{
    Scene scene = make_cubes(5);
    scene.domain = cut_anew(scene.domain, divisions);
    return scene;
}

// Whether the ray only touches the closed box, at a point or along a side, and never gets inside. Directions whose
// components are powers of two make the quotients exact; others do not graze.
bool grazes(Float3 origin, Float3 direction)
{
    double enter = 0, leave = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& lines = box().scene.domain.lines[static_cast<std::size_t>(axis)];
        const double o = origin[axis], d = direction[axis];
        if (d == 0 && (o <= lines.front() || o >= lines.back())) return true;
        if (d == 0) continue;
        const auto [near, far] = std::minmax({(lines.front() - o) / d, (lines.back() - o) / d});
        enter = std::max(enter, near);
        leave = std::min(leave, far);
    }
    return enter >= leave;
}

// With few large faces on the sides.
Scene cubes_for_rays()
{
    Scene scene = make_cubes(5);
    scene.tets = optimise(scene.tets, {2, 0}, {}).mesh;
    return scene;
}

// All boundary faces that the exact ray meets on its way in: none if it misses the box, or only grazes it.
std::set<uint> brute_force(Float3 origin, Float3 direction, const PackedCubes& cubes = box())
{
    std::set<uint> met;
    if (grazes(origin, direction)) return met;
    const auto& mesh = cubes.scene.tets;
    for (uint index = 0; index < mesh.tets.size(); ++index) {
        for (uint face = 0; face < 4; ++face) {
            if (mesh.tets[index].neighbours[face] != NO_HALF_FACE) continue;
            const auto v = [&](uint k) { return mesh.vertices[mesh.tets[index].vertices[corner(face, k)]]; };
            const auto crossing = cross_exactly(origin, direction, v(0), v(1), v(2));
            const bool entering =
                crossing.edge_side[0] >= 0 && crossing.edge_side[1] >= 0 && crossing.edge_side[2] >= 0;
            if (crossing.met && entering) met.insert(make_half_face(index, face));
        }
    }
    return met;
}

uint look_up(Float3 origin, Float3 direction, const PackedCubes& cubes = box())
{
    const Vec3 d = to_vec3(direction);
    const Ray ray = make_ray(to_vec3(origin), VEC3(flush_tiny(d.x), flush_tiny(d.y), flush_tiny(d.z)));
    const SceneView view = view_of(cubes.packed);
    return entry_half_face(view, entry_index(view, ray));
}

void expect_brute_force(Float3 origin, Float3 direction)
{
    const auto met = brute_force(origin, direction);
    const uint found = look_up(origin, direction);
    if (met.empty())
        EXPECT_EQ(found, NO_HALF_FACE);
    else
        EXPECT_TRUE(met.count(found) == 1) << "entered by another face than the exact ray does";
}

Float3 toward(Float3 from, Float3 to)
{
    return {to.x - from.x, to.y - from.y, to.z - from.z};
}

} // namespace

TEST(Entry, agrees_with_brute_force_from_all_round)
{
    Random random(8);
    int differing = 0;
    int entered = 0;
    for (int i = 0; i < 3000; ++i) {
        const Float3 origin = random.point(-3, 3);
        if (box().scene.domain.contains(origin)) continue;
        const Float3 direction = toward(origin, random.point(-1.2f, 1.2f));
        const auto met = brute_force(origin, direction);
        const uint found = look_up(origin, direction);
        entered += !met.empty();
        differing += met.empty() ? found != NO_HALF_FACE : met.count(found) == 0;
    }
    EXPECT_GT(entered, 1000);
    EXPECT_EQ(differing, 0);
}

TEST(Entry, agrees_with_brute_force_where_faces_lie_across_squares)
{
    for (const std::uint32_t divisions : {0u, 1u, 2u, 3u, 7u, 16u}) {
        const PackedCubes cubes(divisions == 0 ? cubes_for_rays() : cubes_with_squares(divisions));
        Random random(divisions);
        int differing = 0, entered = 0;
        for (int i = 0; i < 2000; ++i) {
            const Float3 origin = random.point(-3, 3);
            if (cubes.scene.domain.contains(origin)) continue;
            const Float3 direction = toward(origin, random.point(-1.2f, 1.2f));
            const auto met = brute_force(origin, direction, cubes);
            const uint found = look_up(origin, direction, cubes);
            entered += !met.empty();
            differing += met.empty() ? found != NO_HALF_FACE : met.count(found) == 0;
        }
        EXPECT_GT(entered, 700);
        EXPECT_EQ(differing, 0) << divisions << " divisions";
    }
}

TEST(Entry, rays_through_lines_of_the_look_up_find_the_face_that_lies_across)
{
    const PackedCubes cubes(cubes_with_squares(8)); // lines that are exact, and inside faces
    const auto& lines = cubes.scene.domain.lines;
    for (std::size_t i = 1; i < 8; ++i)
        for (std::size_t j = 1; j < 8; ++j) {
            const Float3 point{lines[0][i], lines[1][j], lines[2][8]};
            for (const Float3 direction : {Float3{-0.25f, 0.5f, -1}, Float3{0, 0, -1}, Float3{0.5f, 0.5f, -0.125f}}) {
                const Float3 origin{point.x - direction.x, point.y - direction.y, point.z - direction.z};
                const auto met = brute_force(origin, direction, cubes);
                ASSERT_FALSE(met.empty());
                EXPECT_EQ(met.count(look_up(origin, direction, cubes)), 1u) << "line " << i << ", " << j;
            }
        }
}

TEST(Entry, rays_parallel_to_a_side_enter_by_the_side_they_face)
{
    const Float3 low = box().scene.domain.low(), high = box().scene.domain.high();
    const float x = low.x + 0.3f * (high.x - low.x), y = low.y + 0.7f * (high.y - low.y);
    expect_brute_force({x, y, high.z + 1}, {0, 0, -1});
    expect_brute_force({x, y, low.z - 1}, {0, 0, 1});
    expect_brute_force({high.x + 2, y, x}, {-1, 0, 0});
    expect_brute_force({x, y, high.z + 1}, {0, 1, 0}); // outside the box
    EXPECT_EQ(look_up({x, y, high.z + 1}, {0, 0, 1}), NO_HALF_FACE) << "away from the box";
}

TEST(Entry, rays_through_corners_and_edges_of_the_box_and_of_squares_find_a_face_there)
{
    const auto& lines = box().scene.domain.lines;
    const std::size_t n = box().scene.domain.divisions;
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= n; ++j) {
            const Float3 corner_on_side{lines[0][i], lines[1][j], lines[2][n]};
            const Float3 origin{corner_on_side.x + 0.25f, corner_on_side.y - 0.5f, corner_on_side.z + 1};
            expect_brute_force(origin, {-0.25f, 0.5f, -1}); // exact: it passes through the corner itself
            expect_brute_force({corner_on_side.x, corner_on_side.y, lines[2][n] + 1}, {0, 0, -1});
        }
    }
}

TEST(Entry, rays_in_the_plane_of_a_side_or_along_an_edge_of_the_box_miss_it)
{
    const Float3 low = box().scene.domain.low(), high = box().scene.domain.high();
    for (const float y : {low.y, high.y, 0.5f * (low.y + high.y)}) {
        expect_brute_force({low.x - 1, y, high.z}, {1, 0, 0});
        expect_brute_force({low.x - 1, y, high.z}, {1, 0, 0.5f});
        EXPECT_EQ(look_up({low.x - 1, y, high.z}, {1, 0, 0}), NO_HALF_FACE);
    }
    // Through an edge of the box and on inside, the ray does enter.
    EXPECT_NE(look_up({low.x - 1, 0, high.z + 1}, {1, 0, -1}), NO_HALF_FACE);
    expect_brute_force({low.x - 1, 0, high.z + 1}, {1, 0, -1});
}

TEST(Entry, a_ray_at_a_corner_of_the_box_is_not_dropped_between_its_sides)
{
    // Of the planes of its three sides, rounding puts z level with y, y level with x, and z before x.
    const Float3 origin{-0x1.581922p+0f, -0x1.f5964p+0f, -0x1.c7ba6ep+0f};
    const Float3 direction{0x1.128d3ep-2f, 0x1.7ead58p-1f, 0x1.37383p-1f};
    ASSERT_EQ(box().scene.domain.low(), (Float3{-1, -1, -1}));
    EXPECT_NE(look_up(origin, direction), NO_HALF_FACE);
}

TEST(Entry, a_ray_through_a_line_belongs_to_the_square_above_it)
{
    const auto& lines = box().scene.domain.lines;
    const uint n = box().packed.divisions;
    for (uint i = 0; i < n; ++i) {
        const float y = 0.5f * (lines[1][2] + lines[1][3]);
        const Ray ray = make_ray(VEC3(lines[0][i] - 0.25f, y, lines[2][n] + 1), VEC3(0.25f, 0, -1));
        EXPECT_EQ(entry_square(view_of(box().packed), ray), ((2 * 2 + 1) * n + 2) * n + i);
    }
}

TEST(Hit, a_ray_in_the_triangle_s_plane_gets_the_centroid)
{
    const auto& mesh = box().scene.mesh;
    const auto& [a, b, c] = mesh.triangles.front();
    const auto centroid = [&](int axis) {
        return (mesh.vertices[a][axis] + mesh.vertices[b][axis] + mesh.vertices[c][axis]) / 3;
    };
    PackedScene packed = box().packed;
    for (std::size_t quad = 0; quad < 3; ++quad)
        packed.triangles[quad].z = 0; // the first triangle, flattened into z = 0
    const maria::Hit hit =
        hit_on(view_of(packed), make_ray(VEC3(centroid(0) - 2, centroid(1), 0), VEC3(1, 0, 0)), 0, 5, 7, NO_END);
    EXPECT_NEAR(hit.t, 2, 1e-6);
    EXPECT_FLOAT_EQ(hit.u, 1.0f / 3);
    EXPECT_FLOAT_EQ(hit.v, 1.0f / 3);
    EXPECT_EQ(hit.steps, 7u);
}

TEST(Entry, tiny_direction_components_are_dropped)
{
    EXPECT_EQ(flush_tiny(0x1p-21f), 0.0f);
    EXPECT_EQ(flush_tiny(-0x1p-21f), 0.0f);
    EXPECT_EQ(flush_tiny(0x1p-20f), 0x1p-20f);
}
