// Triangles without area are dropped, and leave no gap.
#include "scenes/builder/empty_triangles.h"
#include "scenes/builder/repair/repair.h"
#include "scenes/builder/repair/self_intersection.h"
#include "tests/support/builder_meshes.h"

#include <algorithm>
#include <map>
#include <numeric>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Drops them as the builder does.
std::uint64_t drop_empty(TriangleMesh& mesh, std::vector<std::uint32_t>& origins)
{
    origins.resize(mesh.triangles.size());
    std::iota(origins.begin(), origins.end(), 0u);
    const std::uint64_t split = split_at_empty_triangles(mesh, origins);
    EXPECT_EQ(origins.size(), mesh.triangles.size());
    static_cast<void>(clean_up(mesh, origins));
    return split;
}

void expect_closed(const TriangleMesh& mesh)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
            edges[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    for (const auto& [edge, count] : edges)
        EXPECT_EQ(count, 0);
    EXPECT_EQ(find_self_intersections(mesh).count, 0u);
}

} // namespace

TEST(EmptyTriangles, split_their_neighbours_so_that_no_gap_is_left)
{
    // A tetrahedron whose edge from 0 to 1 has two more vertices on the side of its first face.
    TriangleMesh mesh = tetrahedron();
    mesh.vertices.push_back({0.25f, 0, 0});
    mesh.vertices.push_back({0.75f, 0, 0});
    mesh.triangles[0] = {0, 2, 4};
    mesh.triangles.push_back({4, 2, 5});
    mesh.triangles.push_back({5, 2, 1});
    mesh.triangles.push_back({0, 4, 1}); // without area, as is the next
    mesh.triangles.push_back({4, 5, 1});
    std::vector<std::uint32_t> origins;
    EXPECT_EQ(drop_empty(mesh, origins), 2u) << "and again a piece of it";
    expect_closed(mesh);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_EQ(std::count(origins.begin(), origins.end(), 1u), 3) << "pieces are of the triangle that was split";
}

TEST(EmptyTriangles, split_neighbours_that_have_vertices_of_their_own_at_the_same_place)
{
    TriangleMesh mesh = tetrahedron();
    mesh.vertices.insert(mesh.vertices.end(), {{0.5f, 0, 0}, {0, 0, 0}, {1, 0, 0}});
    mesh.triangles[0] = {0, 2, 4};
    mesh.triangles.push_back({4, 2, 1});
    mesh.triangles.push_back({5, 4, 6});
    std::vector<std::uint32_t> origins;
    EXPECT_EQ(drop_empty(mesh, origins), 1u);
    expect_closed(mesh);
}

TEST(EmptyTriangles, with_a_vertex_twice_leave_no_gap)
{
    TriangleMesh mesh = tetrahedron();
    mesh.triangles.push_back({1, 1, 2});
    std::vector<std::uint32_t> origins;
    EXPECT_EQ(drop_empty(mesh, origins), 0u);
    EXPECT_EQ(mesh, tetrahedron());
}

TEST(EmptyTriangles, of_chains_that_cover_each_other_end)
{
    // Every triangle of nine vertices on a line: all are empty, and each is the neighbour of others.
    TriangleMesh mesh;
    for (int i = 0; i < 9; ++i)
        mesh.vertices.push_back({static_cast<float>(i), 0, 0});
    for (std::uint32_t a = 0; a < 9; ++a)
        for (std::uint32_t b = a + 1; b < 9; ++b)
            for (std::uint32_t c = b + 1; c < 9; ++c)
                mesh.triangles.push_back({b, a, c});
    std::vector<std::uint32_t> origins;
    drop_empty(mesh, origins);
    EXPECT_TRUE(mesh.triangles.empty());
}
