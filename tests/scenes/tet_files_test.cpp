// Files of tets: read alike from every format, refused by line and number, and unchanged in a scene.
#include "scenes/builder/own_tets.h"
#include "scenes/builder/run_tetgen.h"
#include "scenes/export_tets.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/scenes/mesh_samples.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/sound_tets.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

// Two tets with a common face, of regions 5 and 6.
const std::string two_medit = "MeshVersionFormatted 2\nDimension\n3\n# a comment\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 "
                              "1\n0 0 1 1\n1 1 1 1\nTriangles 1\n1 2 3 8\nTetrahedra\n2\n1 2 3 4 5\n3 2 4 5 6\nEnd\n";
const std::string gmsh_points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n40 0 0 1\n5 1 1 1\n";
const std::string two_gmsh_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"a name\"\n"
                               "$EndPhysicalNames\n$Nodes\n5\n" +
                               gmsh_points +
                               "$EndNodes\n$Elements\n3\n1 2 2 8 8 1 2 3\n7 4 2 5 1 1 2 3 40\n9 4 2 0 6 3 2 40 "
                               "5\n$EndElements\n";
const std::string two_gmsh_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 1 2\n1 0 0 0 0\n1 0 0 0 1 1 1 0 0\n"
    "1 0 0 0 1 1 1 1 5 1 1\n2 0 0 0 1 1 1 1 6 0\n$EndEntities\n$Nodes\n2 5 1 40\n2 1 1 1\n1\n0 0 0 0.5 0.5\n3 1 0 4\n"
    "2\n3\n40\n5\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n$Elements\n3 3 1 9\n2 1 2 1\n1 1 2 3\n3 1 4 1\n7 1 2 3 40\n"
    "3 2 4 1\n9 3 2 40 5\n$EndElements\n";
template <class Value>
std::string packed(std::initializer_list<Value> values)
{
    std::string bytes;
    for (const Value value : values)
        bytes += bytes_of(value, true);
    return bytes;
}
/// The same in binary, version 2.2 or 4.1.
std::string binary_gmsh(int version)
{
    const auto words = packed<std::int32_t>;
    const auto sizes = packed<std::uint64_t>;
    const auto reals = packed<double>;
    const std::string end = "\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"a name\"\n$EndPhysicalNames\n";
    if (version == 2)
        return "$MeshFormat\n2.2 1 8\n" + words({1}) + end + "$Nodes\n5\n" + words({1}) + reals({0, 0, 0}) +
               words({2}) + reals({1, 0, 0}) + words({3}) + reals({0, 1, 0}) + words({40}) + reals({0, 0, 1}) +
               words({5}) + reals({1, 1, 1}) + "\n$EndNodes\n$Elements\n3\n" + words({2, 1, 2, 1, 8, 8, 1, 2, 3}) +
               words({4, 2, 2, 7, 5, 1, 1, 2, 3, 40, 9, 0, 6, 3, 2, 40, 5}) + "\n$EndElements\n";
    return "$MeshFormat\n4.1 1 8\n" + words({1}) + end + "$Entities\n" + sizes({1, 0, 0, 2}) + words({1}) +
           reals({0, 0, 0}) + sizes({0}) + words({1}) + reals({0, 0, 0, 1, 1, 1}) + sizes({1}) + words({5}) +
           sizes({1}) + words({1}) + words({2}) + reals({0, 0, 0, 1, 1, 1}) + sizes({1}) + words({6}) + sizes({0}) +
           "\n$EndEntities\n$Nodes\n" + sizes({2, 5, 1, 40}) + words({2, 1, 1}) + sizes({1, 1}) +
           reals({0, 0, 0, 0.5, 0.5}) + words({3, 1, 0}) + sizes({4, 2, 3, 40, 5}) +
           reals({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}) + "\n$EndNodes\n$Elements\n" + sizes({3, 3, 1, 9}) +
           words({2, 1, 2}) + sizes({1, 1, 1, 2, 3}) + words({3, 1, 4}) + sizes({1, 7, 1, 2, 3, 40}) +
           words({3, 2, 4}) + sizes({1, 9, 3, 2, 40, 5}) + "\n$EndElements\n";
}
const std::string vtk_points =
    "\na title # of any kind\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0\n0 1 0\n0 0 1 1 1 1\n";
const std::string two_vtk_2 =
    "# vtk DataFile Version 2.0" + vtk_points +
    "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 2 1 3 4\nCELL_TYPES 3\n5\n10\n10\nPOINT_DATA 5\nSCALARS "
    "region int 1\nLOOKUP_TABLE default\n1 2 3 4 5\nCELL_DATA 3\nFIELD FieldData 2\nother 2 3 "
    "int\n1 2 3 4 5 6\nmedit:ref 1 3 int\n8 5 6\n";
const std::string two_vtk_5 = "# vtk DataFile Version 5.1" + vtk_points +
                              "METADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n0 3 7 11\nCONNECTIVITY "
                              "vtktypeint64\n0 1 2 0 1 2 3 2 1 3 4\nCELL_TYPES 3\n5 10 10\nCELL_DATA 3\nSCALARS region "
                              "int\nLOOKUP_TABLE default\n8 5 6\n";
const std::string two_nodes = "# from TetGen\n5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n";
const std::string two_elements = "2 4 1\n1 1 2 3 4 5\n2 3 2 4 5 6\n";

void expect_two(const MeshSoup& soup, std::uint32_t first, std::uint32_t second)
{
    EXPECT_EQ(soup.source_tets, (std::vector<SourceTet>{{first, 5}, {second, 6}}));
    ASSERT_EQ(soup.tets.size(), 2u);
    std::vector<std::set<std::array<float, 3>>> corners(2);
    for (std::size_t i = 0; i < 2; ++i)
        for (const std::uint32_t vertex : soup.tets[i]) {
            const Float3 v = soup.mesh.vertices.at(vertex);
            corners[i].insert({v.x, v.y, v.z});
        }
    using Set = std::set<std::array<float, 3>>;
    EXPECT_EQ(corners[0], (Set{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(corners[1], (Set{{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(soup.mesh.triangles.size(), 7u) << "six of the hull, and one between two regions";
}

/// Vertices and tets as a MEDIT file.
std::string medit(const std::string& vertices, const std::string& tets)
{
    const auto count = [](const std::string& text) { return std::ranges::count(text, '\n'); };
    return fmt::format("MeshVersionFormatted 2\nDimension 3\nVertices {}\n{}Tetrahedra {}\n{}End\n", count(vertices),
                       vertices, count(tets), tets);
}

class TetFiles : public Builder {
protected:
    /// What the builder makes of a file, with switches that leave the hull whole.
    [[nodiscard]] Scene build(const std::filesystem::path& mesh, bool for_rays = false) const
    {
        BuilderOptions options;
        options.mesh = mesh;
        options.tets = for_rays ? TetsKind::rays : TetsKind::cdt;
        options.optimise_own = for_rays;
        options.divisions = 2;
        options.switches = "pY";
        const BuilderTalk silent{[](const std::string&) {}, [](const std::string&) {}};
        PreparedScene prepared = prepare_scene(options, silent);
        const RawTets filled = run_tetgen(prepared.facets(), prepared.surface, prepared.points, options.switches);
        return finish_scene(std::move(prepared), filled, silent);
    }
    [[nodiscard]] std::string refusal(const std::string& bytes) const
    {
        const auto file = write("bad.mesh", bytes);
        return error_of([&] { (void)build(file); });
    }
};

} // namespace

TEST_F(TetFiles, of_all_formats_have_the_same_tets_numbers_and_regions)
{
    expect_two(parse_mesh("a.mesh", two_medit), 1, 2);
    expect_two(parse_mesh("stdin", two_medit), 1, 2);
    expect_two(parse_mesh("a.msh", two_gmsh_2), 7, 9);
    expect_two(parse_mesh("a.msh", two_gmsh_4), 7, 9);
    expect_two(parse_mesh("a.msh", binary_gmsh(2)), 7, 9);
    expect_two(parse_mesh("a.msh", binary_gmsh(4)), 7, 9);
    expect_two(parse_mesh("a.vtk", two_vtk_2), 1, 2);
    expect_two(parse_mesh("a.vtk", two_vtk_5), 1, 2);
    write_file(folder_ / "a.node", two_nodes);
    write_file(folder_ / "a.ele", two_elements);
    expect_two(read_mesh(folder_ / "a.ele"), 1, 2);
    expect_two(read_mesh(folder_ / "a.node"), 1, 2);
}

TEST_F(TetFiles, of_points_alone_have_delaunays_tets_with_the_smallest_marker_of_their_corners)
{
    std::string text = "40 3 0 1\n";
    std::vector<Double3> points;
    for (std::size_t i = 0; i < 40; ++i) {
        const auto digit = [&](std::size_t factor) { return static_cast<double>(i * factor % 41) / 8; };
        points.push_back({digit(5), digit(17), digit(29)});
        text += fmt::format("{} {} {} {} {}\n", i, points[i].x, points[i].y, points[i].z, i % 3);
    }
    const auto file = write("points.node", text);
    const MeshSoup soup = read_mesh(file);
    ASSERT_GE(soup.tets.size(), 60u);
    double volume = 0;
    for (std::size_t i = 0; i < soup.tets.size(); ++i) {
        const auto at = [&](std::size_t k) { return to_double(soup.mesh.vertices[soup.tets[i].at(k)]); };
        const Double3 a = at(1) - at(0), b = at(2) - at(0), c = at(3) - at(0);
        const double six = dot(cross(a, b), c);
        ASSERT_GT(six, 0) << "positive";
        volume += six / 6;
        const Double3 centre =
            (cross(b, c) * dot(a, a) + cross(c, a) * dot(b, b) + cross(a, b) * dot(c, c)) * (0.5 / six);
        std::int32_t least = 2;
        for (std::size_t p = 0; p < points.size(); ++p) {
            EXPECT_GE(length(points[p] - at(0) - centre), length(centre) * (1 - 1e-9)) << "in the sphere of tet " << i;
            for (std::size_t k = 0; k < 4; ++k)
                if (points[p] == at(k)) least = std::min(least, static_cast<std::int32_t>(p % 3));
        }
        EXPECT_EQ(soup.source_tets[i].region, least);
    }
    const Scene scene = build(file);
    expect_sound(scene);
    EXPECT_EQ(scene.source_tets, soup.source_tets);
    expect_error("flat.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 1 1 0\n", {"all 4 lie in a plane"});
}

TEST_F(TetFiles, that_are_damaged_are_refused_with_place_and_line)
{
    const auto changed = [](std::string text, const std::string& what, const std::string& into) {
        const auto at = text.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        return text.replace(at, what.size(), into);
    };
    const struct {
        std::string name, text, what, into;
        std::vector<std::string> parts;
    } cases[] = {
        {"a.mesh", two_medit, "3 2 4 5 6", "3 2 4 6 6", {"tet 2 (line 17)", "none of the 5 vertices"}},
        {"a.mesh", two_medit, "1 2 3 4 5", "1 2 x 4 5", {"tet 1 (line 16)", "'x' is not a whole number"}},
        {"a.mesh", two_medit, "0 1 0 1", "0 nan 0 1", {"vertex 3 (line 9)", "coordinate y is not a number"}},
        {"a.mesh", two_medit, "\n2\n1", "\n9999\n1", {"Tetrahedra", "announces 9999 tets", "cannot hold"}},
        {"a.mesh", two_medit, "5 6\nEnd\n", "", {"tet 2 (line", "the file ends inside it"}},
        {"a.mesh", two_medit, "Triangles 1\n1 2 3 8", "Hexahedra 1\n1", {"Hexahedra (line 12)", "not tets", "Gmsh"}},
        {"a.mesh", two_medit, "Dimension\n3", "Dimension\n2", {"2 dimensions"}},
        {"a.msh", two_gmsh_2, "3 2 40", "3 2 41", {"element 3 of 3 (line 20)", "node 41 is not in the file"}},
        {"a.msh", two_gmsh_2, "2.2 0", "2.2 1", {"$MeshFormat", "their bytes another order"}},
        {"a.msh", binary_gmsh(2), "$EndNodes", "$EndKnots", {"$Nodes: its end is missing"}},
        {"a.msh", binary_gmsh(4), "$EndElements\n", "", {"$Elements: its end is missing"}},
        {"a.msh", binary_gmsh(4).substr(0, 500), "$", "$", {"$Nodes: the file ends inside it"}},
        {"a.msh", two_gmsh_2, "2.2 0", "4.0 0", {"version 4.0", "msh41"}},
        {"a.msh", two_gmsh_2, "7 4 2", "7 5 2", {"element 7 has type 5, which is not a tet"}},
        {"a.msh", two_gmsh_2, "40 0 0 1", "3 0 0 1", {"node 4 of 5 (line 13)", "node 3 is there twice"}},
        {"a.msh", two_gmsh_4, "9 3 2 40 5\n", "9 3 2\n", {"element 1 of block 3 (line 33)", "too few nodes"}},
        {"a.msh", two_gmsh_4, "$EndElements\n", "", {"ends inside it"}},
        {"a.vtk", two_vtk_2, "4 2 1 3 4", "4 2 1 3 7", {"cell 2 (line 12)", "none of the 5 vertices"}},
        {"a.vtk", two_vtk_2, "ASCII", "BINARY", {"(line 3)", "binary", "meshio ascii"}},
        {"a.vtk", two_vtk_2, "CELL_TYPES 3\n5\n10", "CELL_TYPES 3\n5\n12", {"cell 1 (line 11)", "type is 12"}},
        {"a.vtk", two_vtk_5, "8 5 6", "8 5.5 6", {"array region (line 22)", "5.5 is not a whole number"}},
        {"a.vtk", two_vtk_5, "0 3 7 11", "0 3 2 11", {"cell 1", "offsets are wrong"}},
        {"a.ele", two_elements, "2 4 1", "2 4 1", {"a.node, which cannot be read", "in one folder"}},
    };
    for (const auto& bad : cases)
        expect_error(bad.name, changed(bad.text, bad.what, bad.into), bad.parts);
    write_file(folder_ / "b.ele", two_elements);
    write_file(folder_ / "b.node", changed(two_nodes, "4 0 0 1", "6 0 0 1"));
    EXPECT_TRUE(contains(error_of([&] { (void)read_mesh(folder_ / "b.ele"); }),
                         "the .node file, vertex 4 of 5 (line 6): it has the number 6"));
}

TEST_F(TetFiles, whose_tets_overlap_or_are_flat_are_refused_by_number)
{
    const std::string corner = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
    EXPECT_TRUE(contains(refusal(medit(corner + "1 1 1 0\n0 0 2 0\n", "1 2 3 4 1\n2 3 4 5 1\n2 3 4 6 1\n")),
                         "tets 1, 2 and 3 share one face"));
    EXPECT_TRUE(contains(refusal(medit(corner + "0.1 0.1 0.1 0\n", "1 2 3 4 1\n2 3 4 5 1\n")),
                         "tets 1 and 2 are on the same side of their face"));
    EXPECT_TRUE(contains(refusal(medit(corner + "1 1 0 0\n", "1 2 3 4 1\n2 3 1 5 1\n")), "tet 2: it is flat"));
    EXPECT_TRUE(contains(refusal(medit(corner + "0.33333333333 0.33333333333 0.33333333333 0\n", "2 3 4 5 1\n")),
                         "tet 1 is flat or inverted once its vertices are rounded"))
        << "the last vertex is below the others' plane, and above as floats";
    const std::string other = "0.1 0.1 0.1 0\n2 0.1 0.1 0\n0.1 2 0.1 0\n0.1 0.1 2 0\n";
    const std::string crossing = refusal(medit(corner + other, "1 2 3 4 1\n5 6 7 8 1\n"));
    EXPECT_TRUE(contains(crossing, "the first of tets 1 and 2")) << crossing;
    const std::string inner = "0.1 0.1 0.1 0\n0.2 0.1 0.1 0\n0.1 0.2 0.1 0\n0.1 0.1 0.2 0\n";
    const std::string nested = refusal(medit(corner + inner, "1 2 3 4 1\n5 6 7 8 1\n"));
    EXPECT_TRUE(contains(nested, "of parts that overlap")) << nested;
    EXPECT_TRUE(nested.starts_with("invalid_input")) << nested;
}

TEST_F(TetFiles, are_in_the_scene_unchanged_and_come_back_from_each_format)
{
    // Cubes of six tets with holes in it, a cavity, and parts of several regions.
    const Scene cubes = make_cubes(6);
    export_tets(cubes, folder_ / "cubes.mesh");
    export_tets(cubes, folder_ / "cubes.vtk");
    const std::string vtk = read_text(folder_ / "cubes.vtk"), head = "SCALARS cost double 1\nLOOKUP_TABLE default\n";
    std::istringstream costs(vtk.substr(vtk.find(head) + head.size()));
    EXPECT_NEAR(std::accumulate(std::istream_iterator<double>(costs), {}, 0.0),
                optimise(cubes.tets, {.effort = 0}, {}).report.cost_before, 1e-9);
    const MeshSoup all = read_mesh(folder_ / "cubes.mesh");
    ASSERT_EQ(all.tets.size(), cubes.tets.tets.size());
    std::string vertices, tets;
    for (const Float3 v : all.mesh.vertices)
        vertices += fmt::format("{} {} {} 0\n", v.x, v.y, v.z);
    for (std::size_t i = 0; i < all.tets.size(); ++i) {
        const auto& [a, b, c, d] = all.tets[i];
        const std::size_t cube = i / 6;
        if (cube == 1 + 6 + 36 || cube == 2 || cube % 7 == 3) continue;
        tets += fmt::format("{} {} {} {} {}\n", a + 1, b + 1, c + 1, d + 1, static_cast<int>(cube % 3) - 1);
    }
    const auto file = write("some.mesh", medit(vertices, tets));
    const MeshSoup given = read_mesh(file);
    const Scene scene = build(file);
    expect_sound(scene);
    EXPECT_EQ(scene.source_tets, given.source_tets);
    const float scale = std::ldexp(1.0f, scene.build.scale_exponent);
    for (std::size_t i = 0; i < given.tets.size(); ++i) {
        std::set<std::array<float, 3>> wanted, found;
        for (std::size_t k = 0; k < 4; ++k) {
            const Float3 a = given.mesh.vertices[given.tets[i][k]],
                         b = scene.tets.vertices[scene.tets.tets[i].vertices[k]];
            wanted.insert({a.x * scale, a.y * scale, a.z * scale});
            found.insert({b.x, b.y, b.z});
            const std::uint32_t across = scene.tets.tets[i].neighbours[k];
            ASSERT_NE(across, NO_HALF_FACE);
            const bool same_region = half_face_tet(across) < given.tets.size() &&
                                     given.source_tets[half_face_tet(across)].region == given.source_tets[i].region;
            ASSERT_EQ(scene.tets.tets[i].faces[k] == FREE_FACE, same_region);
        }
        ASSERT_EQ(wanted, found) << "tet " << i;
    }
    write_scene(folder_ / "a.tet", scene);
    EXPECT_EQ(read_scene(folder_ / "a.tet"), scene);

    for (const std::string name : {"out.vtk", "out.mesh", "out.node"}) {
        export_tets(scene, folder_ / name);
        const MeshSoup back = read_mesh(folder_ / name);
        ASSERT_EQ(back.tets.size(), scene.tets.tets.size());
        for (std::size_t i = 0; i < back.tets.size(); ++i) {
            for (std::size_t k = 0; k < 4; ++k) // turned over, so its first two corners are exchanged
                ASSERT_EQ(back.mesh.vertices[back.tets[i][k]].x * scale,
                          scene.tets.vertices[scene.tets.tets[i].vertices[k < 2 ? 1 - k : k]].x);
            ASSERT_EQ(back.source_tets[i].region, i < given.tets.size() ? given.source_tets[i].region : -2) << name;
        }
    }
}

TEST_F(TetFiles, are_optimised_within_their_regions_if_that_is_asked_for)
{
    // Cubes of six tets in two regions, with a hole and a cavity.
    export_tets(make_cubes(6), folder_ / "cubes.mesh");
    const MeshSoup all = read_mesh(folder_ / "cubes.mesh");
    std::string vertices, tets;
    for (const Float3 v : all.mesh.vertices)
        vertices += fmt::format("{} {} {} 0\n", v.x, v.y, v.z);
    for (std::size_t i = 0; i < all.tets.size(); ++i) {
        const auto& [a, b, c, d] = all.tets[i];
        const std::size_t cube = i / 6;
        if (cube == 2 + 6 * 2 + 36 * 2 || cube == 2) continue;
        tets += fmt::format("{} {} {} {} {}\n", a + 1, b + 1, c + 1, d + 1, cube % 6 < 3 ? -4 : 5);
    }
    const auto file = write("some.mesh", medit(vertices, tets));
    const Scene own = build(file), rays = build(file, true);
    EXPECT_EQ(own.build.optimised.tets, TetsKind::cdt);
    ASSERT_EQ(rays.build.optimised.tets, TetsKind::rays) << rays.build.optimised.reason;
    EXPECT_EQ(rays.mesh, own.mesh);
    expect_same_domain(rays.tets, own);
    EXPECT_LT(rays.build.optimised.cost_after, 0.9 * rays.build.optimised.cost_before);
    EXPECT_NE(rays.source_tets.size(), own.source_tets.size());
    EXPECT_EQ(numbers_of(own).front(), 1);
    EXPECT_EQ(numbers_of(rays), std::vector<std::int64_t>(rays.tets.tets.size(), -1));

    const auto volumes = [](const Scene& scene) {
        std::map<std::int64_t, double> sums;
        const std::vector<double> each = volumes_of(scene);
        const std::vector<std::int64_t> regions = regions_of(scene);
        for (std::size_t i = 0; i < each.size(); ++i)
            sums[regions[i]] += each[i];
        return sums;
    };
    const auto before = volumes(own), after = volumes(rays);
    ASSERT_EQ(before.size(), 3u);
    ASSERT_EQ(after.size(), 3u);
    for (const auto& [region, volume] : before)
        EXPECT_NEAR(after.at(region), volume, 1e-12) << region;
    const std::vector<std::int64_t> regions = regions_of(rays);
    for (std::size_t i = 0; i < regions.size(); ++i)
        for (std::size_t face = 0; face < 4; ++face) {
            const Tet& tet = rays.tets.tets[i];
            const std::uint32_t across = tet.neighbours[face] == NO_HALF_FACE ? static_cast<std::uint32_t>(i)
                                                                              : half_face_tet(tet.neighbours[face]);
            ASSERT_EQ(regions[across] == regions[i], tet.faces[face] == FREE_FACE);
        }
    export_tets(rays, folder_ / "rays.vtu");
    const std::string text = read_text(folder_ / "rays.vtu"),
                      head = "Name=\"cost\" NumberOfComponents=\"1\" format=\"ascii\">";
    ASSERT_NE(text.find(head), std::string::npos);
    std::istringstream costs(text.substr(text.find(head) + head.size()));
    EXPECT_NEAR(std::accumulate(std::istream_iterator<double>(costs), {}, 0.0), rays.build.optimised.cost_after, 1e-9)
        << "inside the regions too";
}
