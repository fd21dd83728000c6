#include "core/mesh/entry_grid.h"

#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"
#include "scenes/procedural.h"
#include "tests/support/cut_anew.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::span<const std::uint32_t> list_of(const EntryGrid& grid, std::size_t square)
{
    return std::span(grid.half_faces).subspan(grid.ranges[square], grid.ranges[square + 1] - grid.ranges[square]);
}

/// How far a point of a side's plane is inside a boundary face, along the face's plane; negative outside.
double depth_in(const TetMesh& mesh, std::uint32_t half_face, Double3 point)
{
    double least = 1e9;
    const auto at = [&](std::size_t i) {
        return to_double(mesh.vertices[mesh.tets[half_face_tet(half_face)]
                                           .vertices[face_corners[half_face_index(half_face)][i % 3]]]);
    };
    const Double3 normal = cross(at(1) - at(0), at(2) - at(0));
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 inwards = cross(normal, at(i + 1) - at(i));
        least = std::min(least, dot(point - at(i), inwards) / length(inwards));
    }
    return least;
}

/// A point of a square, numbered within its side, or up to `reach` outside its outline.
Double3 point_near(const Domain& domain, std::uint32_t side, std::uint32_t square, double reach, Random& random)
{
    const std::uint32_t across = side / 2, n = domain.divisions;
    std::array<double, 3> at{};
    at[across] = side % 2 == 0 ? domain.lines[across].front() : domain.lines[across].back();
    for (std::uint32_t k = 0; k < 2; ++k) {
        const std::uint32_t axis = (across + 1 + k) % 3, i = k == 0 ? square % n : square / n;
        const double low = domain.lines[axis][i] - reach, high = domain.lines[axis][i + 1] + reach;
        const double part =
            random.below(4) == 0 ? static_cast<float>(random.below(2)) : random.unit(); // some on the outline
        at[axis] = low + (high - low) * part;
    }
    return {at[0], at[1], at[2]};
}

} // namespace

TEST(EntryGrid, lists_each_face_of_a_side_once)
{
    const Scene scene = make_cubes(4);
    const EntryGrid grid = make_entry_grid(scene.domain, scene.tets);
    ASSERT_EQ(grid.ranges.size(), 6u * 4 * 4 + 7);
    EXPECT_EQ(grid.ranges.back(), grid.half_faces.size());
    std::set<std::uint32_t> seen;
    for (std::uint32_t side = 0; side < 6; ++side) {
        EXPECT_EQ(faces_of_side(grid, side).size(), 2u * 4 * 4);
        for (const std::uint32_t half_face : faces_of_side(grid, side)) {
            EXPECT_TRUE(seen.insert(half_face).second);
            const float plane = side % 2 == 0 ? -1.0f : 1.0f;
            for (const std::uint32_t corner : face_corners[half_face_index(half_face)])
                EXPECT_EQ(scene.tets.vertices[scene.tets.tets[half_face_tet(half_face)].vertices[corner]]
                                             [static_cast<int>(side / 2)],
                          plane);
        }
    }
    EXPECT_EQ(seen.size(), count_faces(scene.tets).boundary_faces);
}

TEST(EntryGrid, begins_the_list_of_a_square_with_the_two_faces_that_cover_it)
{
    const Scene scene = make_cubes(4);
    const EntryGrid grid = make_entry_grid(scene.domain, scene.tets);
    std::set<std::uint32_t> seen;
    for (std::size_t square = 0; square < 6u * 4 * 4; ++square) {
        const auto list = list_of(grid, square);
        ASSERT_GE(list.size(), 2u);
        EXPECT_LE(list.size(), 18u) << "the two, and those that touch them";
        EXPECT_LT(list[0], list[1]) << "equal shares in the order of links";
        seen.insert(list.begin(), list.begin() + 2);
    }
    EXPECT_EQ(seen.size(), count_faces(scene.tets).boundary_faces);
}

TEST(EntryGrid, lists_all_faces_at_a_square_and_near_it_whatever_squares_there_are)
{
    const Scene scene = make_cubes(5);
    Random random(90);
    for (const std::uint32_t n : {1u, 2u, 3u, 7u, 16u}) {
        const Domain domain = cut_anew(scene.domain, n);
        const EntryGrid grid = make_entry_grid(domain, scene.tets);
        for (int i = 0; i < 3000; ++i) {
            const std::uint32_t side = random.below(6), square = random.below(n * n);
            const double reach = random.below(2) == 0 ? 0 : 0.99 * entry_margin;
            const Double3 point = point_near(domain, side, square, reach, random);
            const auto list = list_of(grid, side * n * n + square);
            for (const std::uint32_t half_face : faces_of_side(grid, side))
                EXPECT_TRUE(depth_in(scene.tets, half_face, point) < 0 ||
                            std::ranges::find(list, half_face) != list.end())
                    << n << " divisions, square " << square;
        }
    }
}

TEST(EntryGrid, lists_no_face_that_is_far_from_a_square)
{
    const Scene scene = make_cubes(8);
    const EntryGrid grid = make_entry_grid(cut_anew(scene.domain, 4), scene.tets);
    for (std::size_t square = 0; square < 6u * 4 * 4; ++square)
        EXPECT_LE(list_of(grid, square).size(), 32u) << "those of four cubes and of the twelve around them";
}

TEST(EntryGrid, begins_a_list_with_the_face_that_covers_most_of_the_square)
{
    const Scene scene = make_cubes(5);
    const Domain domain = cut_anew(scene.domain, 3);
    const EntryGrid grid = make_entry_grid(domain, scene.tets);
    Random random(91);
    constexpr int points = 500;
    for (std::uint32_t square = 0; square < 6u * 9; ++square) {
        const auto list = list_of(grid, square);
        std::vector<int> met(list.size());
        for (int i = 0; i < points; ++i) {
            const Double3 point = point_near(domain, square / 9, square % 9, 0, random);
            for (std::size_t k = 0; k < list.size(); ++k)
                met[k] += depth_in(scene.tets, list[k], point) >= 0 ? 1 : 0;
        }
        EXPECT_GE(met.front(), *std::ranges::max_element(met) - points / 6) << "square " << square;
    }
}

TEST(EntryGrid, a_boundary_face_inside_the_domain_is_refused)
{
    Scene scene = make_cubes(2);
    for (auto& line : scene.domain.lines)
        line.back() += 0.25f; // the tets no longer reach the box
    EXPECT_THROW((void)make_entry_grid(scene.domain, scene.tets), Error);
}

TEST(EntryGrid, a_boundary_face_that_reaches_outside_its_side_is_refused)
{
    Scene scene = make_cubes(2);
    for (float& line : scene.domain.lines[1])
        line *= 0.5f; // the sides across x keep their planes, and the tets stick out of them
    EXPECT_THROW((void)make_entry_grid(scene.domain, scene.tets), Error);
}

TEST(EntryGrid, a_square_without_a_face_is_refused)
{
    Scene scene = make_cubes(2);
    for (Tet& tet : scene.tets.tets)
        for (std::uint32_t& half_face : tet.neighbours)
            if (half_face == NO_HALF_FACE) half_face = 0; // no boundary is left
    EXPECT_THROW((void)make_entry_grid(scene.domain, scene.tets), Error);
}
