// The meshes that are made here in any size: their sizes, their bits, what is closed and what is open.
#include "core/base/hash.h"
#include "scenes/catalogue.h"
#include "scenes/procedural.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<CatalogueEntry> procedural_rows()
{
    std::vector<CatalogueEntry> rows = catalogue();
    std::erase_if(rows, [](const CatalogueEntry& row) { return row.source != SceneSource::procedural; });
    return rows;
}

/// How many triangles an edge has, for each edge.
std::map<std::array<std::uint32_t, 2>, std::size_t> edges_of(const TriangleMesh& mesh)
{
    std::map<std::array<std::uint32_t, 2>, std::size_t> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++edges[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
    return edges;
}

std::size_t edges_with(const TriangleMesh& mesh, std::size_t triangles)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(edges_of(mesh), [&](const auto& edge) { return edge.second == triangles; }));
}

double area_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t)
{
    const Double3 a = to_double(mesh.vertices[t[0]]), b = to_double(mesh.vertices[t[1]]),
                  c = to_double(mesh.vertices[t[2]]);
    return length(cross(b - a, c - a)) / 2;
}

std::string written_hash(const TriangleMesh& mesh)
{
    return hash_text(hash_of(mesh.triangles, hash_of(mesh.vertices)));
}

} // namespace

TEST(ProceduralMeshes, have_about_as_many_triangles_as_a_name_asks_for)
{
    for (const CatalogueEntry& row : procedural_rows())
        for (const std::uint32_t triangles : {row.procedural->least, 20'000u, 70'000u, 300'000u})
            EXPECT_NEAR(static_cast<double>(row.procedural->make(triangles).triangles.size()), triangles,
                        0.13 * triangles + 300)
                << row.name;
}

TEST(ProceduralMeshes, have_no_double_and_no_unused_vertex_and_no_flat_or_double_triangle)
{
    for (const CatalogueEntry& row : procedural_rows()) {
        const TriangleMesh mesh = row.procedural->make(row.procedural->least);
        std::set<std::array<float, 3>> places;
        for (const Float3 p : mesh.vertices)
            places.insert({p.x, p.y, p.z});
        EXPECT_EQ(places.size(), mesh.vertices.size()) << row.name;
        std::set<std::uint32_t> used;
        std::set<std::array<std::uint32_t, 3>> triangles;
        for (std::array<std::uint32_t, 3> t : mesh.triangles) {
            EXPECT_GT(area_of(mesh, t), 0) << row.name;
            used.insert(t.begin(), t.end());
            std::ranges::sort(t);
            triangles.insert(t);
        }
        EXPECT_EQ(used.size(), mesh.vertices.size()) << row.name;
        EXPECT_EQ(triangles.size(), mesh.triangles.size()) << row.name;
    }
}

// Cameras are placed by the box.
TEST(ProceduralMeshes, have_one_box_at_every_size)
{
    for (const CatalogueEntry& row : procedural_rows()) {
        const BoundingSphere usual = bounding_sphere(row.procedural->usual());
        for (const std::uint32_t triangles : {2 * row.procedural->least, 60'000u}) {
            const BoundingSphere sized = bounding_sphere(row.procedural->make(triangles));
            EXPECT_NEAR(sized.radius, usual.radius, 0.02 * usual.radius) << row.name;
            EXPECT_LT(length(sized.centre - usual.centre), 0.02 * usual.radius) << row.name;
        }
    }
}

TEST(ProceduralMeshes, are_closed_or_open_as_they_say)
{
    const TriangleMesh spheres = make_spheres(20'000);
    EXPECT_EQ(edges_with(spheres, 2), spheres.triangles.size() * 3 / 2) << "each edge has two triangles";
    EXPECT_EQ(spheres.vertices.size(), spheres.triangles.size() / 2 + 2 * 1000) << "Euler, 1,000 times";
    EXPECT_EQ(edges_with(make_terrain(20'000), 1), 4 * 100u) << "open at its sides only";
    const TriangleMesh nested = make_nested(20'000);
    EXPECT_EQ(edges_with(nested, 2), nested.triangles.size() * 3 / 2);
    EXPECT_EQ(nested.vertices.size(), nested.triangles.size() / 2 + 2 * 4) << "a cube and three spheres";
    const TriangleMesh grass = make_grass(30'512);
    EXPECT_EQ(edges_with(grass, 1), 5 * 10'000u + 4 * 16u) << "around each blade, and around the floor";
    const TriangleMesh plant = make_plant(20'000);
    EXPECT_EQ(edges_with(plant, 1), 120 * (2 * 13u + 4)) << "around each leaf; the stem is closed";
    for (const TriangleMesh& mesh : {make_atrium(20'000), make_city(20'000)}) {
        EXPECT_GT(edges_with(mesh, 1), 300u) << "windows and rims";
        EXPECT_GT(edges_with(mesh, 3), 100u) << "walls that share edges with floors";
    }
}

TEST(ProceduralMeshes, have_the_usual_sizes_that_their_descriptions_state)
{
    EXPECT_EQ(make_grass(68'012).triangles.size(), 3 * 22'500u + 512);
    for (const auto& [name, triangles] : std::map<std::string, double>{{"atrium", 60'000},
                                                                       {"city", 80'000},
                                                                       {"terrain", 180'000},
                                                                       {"spheres", 128'000},
                                                                       {"plant", 41'000},
                                                                       {"nested", 30'000}})
        EXPECT_NEAR(static_cast<double>(find_in_catalogue(name)->procedural->usual().triangles.size()), triangles,
                    0.01 * triangles)
            << name;
}

// The bits were computed once; any machine that rounds as IEEE 754 says must find them again.
TEST(ProceduralMeshes, are_the_same_bits_everywhere)
{
    EXPECT_EQ(written_hash(make_atrium(20'000)), "c79d435f641910ec");
    EXPECT_EQ(written_hash(make_city(20'000)), "00e77c7c3fa782ea");
    EXPECT_EQ(written_hash(make_terrain(20'000)), "eeda525e8d5cb8ef");
    EXPECT_EQ(written_hash(make_spheres(20'000)), "3750e6862406729c");
    EXPECT_EQ(written_hash(make_grass(20'000)), "f18ed7f99c7e0457");
    EXPECT_EQ(written_hash(make_plant(20'000)), "e0c04c1d6e0fbe7f");
    EXPECT_EQ(written_hash(make_nested(20'000)), "08994c41de3bd5a5");
    const std::string field = make_field(2'000);
    EXPECT_EQ(hash_text(hash_of(field)), "a78ed8113095216f");
}

TEST(ProceduralMeshes, are_named_with_a_number_in_their_range)
{
    EXPECT_EQ(find_procedural("city@5000")->triangles, 5'000u);
    EXPECT_EQ(find_procedural("city@5000")->entry.name, "city");
    EXPECT_EQ(find_procedural("city")->triangles, std::nullopt);
    EXPECT_EQ(find_procedural("field@5000")->triangles, 5'000u);
    EXPECT_EQ(error_of([] { (void)find_procedural("field@5"); }),
              "usage: scene field@5: after the @ must be the number of its points, 100 to 4000000");
    for (const char* const other : {"bunny", "bunny@5000", "cubes@5", "cityscape", "lattice:5", "town@5000"})
        EXPECT_FALSE(find_procedural(other)) << other;
    for (const CatalogueEntry& row : procedural_rows())
        for (const std::string number : {"", "x", "1500.5", "-1", "4000001", "99999999999"}) {
            const std::string error = error_of([&] { (void)find_procedural(row.name + "@" + number); });
            EXPECT_EQ(error, "usage: scene " + row.name + "@" + number +
                                 ": after the @ must be the number of its triangles, " +
                                 std::to_string(row.procedural->least) + " to 4000000");
        }
}
