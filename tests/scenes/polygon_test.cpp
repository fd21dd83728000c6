// Polygons of mesh files become triangles: none lost, none without area, none outside.
#include "scenes/builder/polygon.h"
#include "tests/scenes/mesh_samples.h"
#include "tests/support/random.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Triangles = std::vector<std::array<std::size_t, 3>>;
using Points = std::vector<Float3>;

Double3 area_of(const Points& corners, const std::array<std::size_t, 3>& triangle)
{
    const Double3 a = to_double(corners[triangle[0]]);
    return cross(to_double(corners[triangle[1]]) - a, to_double(corners[triangle[2]]) - a) * 0.5;
}

/// Newell's: its length is the area of a flat polygon.
Double3 area_of(const Points& corners)
{
    Double3 sum;
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum = sum + area_of(corners, {0, i - 1, i});
    return sum;
}

/// Every triangle has an area and is oriented as the flat polygon, the areas add up, and the edges that only one
/// triangle has are the polygon's.
void expect_tiling(const Points& corners, const CutPolygon& cut, std::size_t triangles)
{
    EXPECT_TRUE(cut.is_simple);
    EXPECT_EQ(cut.triangles.size(), triangles);
    const Double3 whole = area_of(corners);
    double sum = 0;
    std::map<std::pair<std::size_t, std::size_t>, int> open;
    for (const auto& triangle : cut.triangles) {
        const Double3 area = area_of(corners, triangle);
        ASSERT_GT(dot(area, whole), 0);
        sum += length(area);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t a = triangle[i], b = triangle[(i + 1) % 3];
            open[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    EXPECT_NEAR(sum, length(whole), 1e-5 * length(whole));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t a = i, b = (i + 1) % corners.size();
        open[std::minmax(a, b)] -= a < b ? 1 : -1;
    }
    for (const auto& [edge, count] : open)
        EXPECT_EQ(count, 0) << edge.first << " " << edge.second;
}

/// A wheel with that many teeth, in a plane that is not one of the axes'.
Points gear(std::size_t teeth)
{
    Points corners;
    for (std::size_t i = 0; i < 2 * teeth; ++i) {
        const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(teeth);
        const double radius = i % 2 == 0 ? 1 : 0.9, x = radius * std::cos(angle), y = radius * std::sin(angle);
        corners.push_back(to_float(Double3{x, y, 0.25 * x + 0.5 * y}));
    }
    return corners;
}

Points turned(Points corners)
{
    std::reverse(corners.begin(), corners.end());
    return corners;
}

} // namespace

TEST(Polygon, that_is_convex_is_a_fan)
{
    EXPECT_EQ(cut_polygon(Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).triangles,
              (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, of_any_number_of_corners_is_cut_into_triangles_inside_it)
{
    for (const std::size_t teeth : {3u, 7u, 501u, 3000u, 40000u}) {
        expect_tiling(gear(teeth), cut_polygon(gear(teeth)), 2 * teeth - 2);
        expect_tiling(turned(gear(teeth)), cut_polygon(turned(gear(teeth))), 2 * teeth - 2);
    }
}

TEST(Polygon, that_is_not_convex_is_tiled_in_every_plane_from_every_corner)
{
    Random random(43);
    for (int run = 0; run < 200; ++run) {
        const std::size_t count = 4 + random.below(20);
        Points corners;
        for (std::size_t i = 0; i < count; ++i) { // seen from the origin, each corner is further round
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
            const double radius = 0.1 + 0.001 * random.below(900);
            const double x = radius * std::cos(angle), y = radius * std::sin(angle), z = 0.5 * x - 0.25 * y;
            corners.push_back(to_float(run % 3 == 0   ? Double3{x, y, z}
                                       : run % 3 == 1 ? Double3{z, x, y}
                                                      : Double3{y, z, x}));
        }
        SCOPED_TRACE(run);
        expect_tiling(corners, cut_polygon(corners), count - 2);
        expect_tiling(turned(corners), cut_polygon(turned(corners)), count - 2);
    }
}

TEST(Polygon, has_no_triangle_without_area_where_corners_are_on_a_line)
{
    const Points square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    for (std::size_t first = 0; first < square.size(); ++first) {
        Points corners = square;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
        expect_tiling(corners, cut_polygon(corners), 6);
        expect_tiling(turned(corners), cut_polygon(turned(corners)), 6);
    }
}

// Which of its triangulations CGAL returns for corners on one circle depends on its version; ours must not.
TEST(Polygon, is_cut_the_same_way_wherever_corners_are_on_one_circle)
{
    // Points 2, 3, 6 and 7 are on a circle.
    const Points gate = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {2, 2, 0}, {2, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
    EXPECT_EQ(cut_polygon(gate).triangles,
              (Triangles{{0, 1, 2}, {0, 2, 7}, {2, 3, 6}, {2, 6, 7}, {3, 4, 5}, {3, 5, 6}}));
    EXPECT_EQ(cut_polygon(turned(gate)).triangles,
              (Triangles{{0, 1, 4}, {0, 4, 5}, {0, 5, 7}, {1, 2, 4}, {2, 3, 4}, {5, 6, 7}}));
}

TEST(Polygon, keeps_a_hole_open_that_an_edge_joins_to_its_outline)
{
    const Points corners = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                            {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    for (const Points& polygon : {corners, turned(corners)}) {
        const CutPolygon cut = cut_polygon(polygon);
        EXPECT_TRUE(cut.is_simple);
        EXPECT_EQ(cut.triangles.size(), 8u);
        double sum = 0;
        for (const auto& triangle : cut.triangles) {
            EXPECT_GT(dot(area_of(polygon, triangle), area_of(polygon)), 0);
            sum += length(area_of(polygon, triangle));
        }
        EXPECT_EQ(sum, 12);
    }
}

TEST(Polygon, that_crosses_itself_or_has_no_area_is_reported)
{
    const CutPolygon bow = cut_polygon(Points{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}});
    EXPECT_FALSE(bow.is_simple);
    EXPECT_EQ(bow.triangles.size(), 2u);
    const CutPolygon line = cut_polygon(Points{{0, 0, 0}, {0, 0, 0}, {1, 0, 1}, {2, 0, 2}, {-1, 0, -1}});
    EXPECT_TRUE(line.is_simple);
    EXPECT_EQ(line.triangles.size(), 3u);
    // The two halves of the second are equally large, and of opposite orientation.
    for (const std::string last : {"0 1 0", "0 2 0"}) {
        const MeshSoup soup = parse_mesh("a.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv " + last + "\nf 1 2 3 4\n");
        EXPECT_EQ(soup.mesh.triangles.size(), 2u);
        ASSERT_EQ(soup.notes.size(), 1u);
        EXPECT_TRUE(contains(soup.notes[0], "1 polygons cross or overlap themselves"));
    }
    for (const Points& none :
         {Points{{0, 0, 0}, {0, 2, 2}, {0, 2, 0}, {0, 0, 2}}, Points{{0, 0, 0}, {2, 2, 4}, {2, 0, 2}, {0, 2, 2}},
          Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}}})
        EXPECT_FALSE(cut_polygon(none).is_simple);
}

TEST(Polygon, of_ply_is_cut_when_all_vertices_are_known)
{
    const std::string head = "ply\nformat ascii 1.0\n",
                      vertices = "element vertex 6\nproperty float x\nproperty float "
                                 "y\nproperty float z\n",
                      faces = "element face 1\nproperty list uchar int vertex_indices\n", end = "end_header\n",
                      positions = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n", face = "6 4 5 0 1 2 3\n";
    const TriangleMesh mesh = parse_mesh("a.ply", head + vertices + faces + end + positions + face).mesh;
    EXPECT_EQ(parse_mesh("b.ply", head + faces + vertices + end + face + positions).mesh, mesh);
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += area_of(mesh.vertices, {a, b, c}).z;
    EXPECT_EQ(sum, 3);
}

TEST(Polygon, keeps_its_place_among_the_triangles)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
    using Faces = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(parse_mesh("a.obj", vertices + "f 1 2 5\nf 1 2 3 4\nf 1 3 5\nf 4 3 2 1\n").mesh.triangles,
              (Faces{{0, 1, 4}, {0, 1, 2}, {0, 2, 3}, {0, 2, 4}, {3, 2, 1}, {3, 1, 0}}));
}
