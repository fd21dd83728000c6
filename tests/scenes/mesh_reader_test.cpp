// What is read from mesh files of every format. What is refused: mesh_refusal_test.cpp.
#include "tests/scenes/mesh_samples.h"

#include <algorithm>
#include <random>

using namespace tetrace;
using namespace tetrace::test;

namespace {

TriangleMesh read(const std::string& name, const std::string& bytes)
{
    return parse_mesh(name, bytes).mesh;
}

} // namespace

TEST(MeshReader, reads_off_with_comments_and_colours)
{
    const auto plain = read("a.off", tetrahedron_off);
    EXPECT_EQ(plain.vertices.size(), 4u);
    EXPECT_EQ(plain.triangles[3], (std::array<std::uint32_t, 3>{0, 3, 2}));
    EXPECT_EQ(
        read("b.off",
             "COFF # colours\n3 1 0\n\n0 0 0 255 0 0 255\n# between\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2 9 9 9\n"),
        read("c.OFF", "NOFF 3 1 0\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 0 0 0 1\r\n3 0 1 2\r\n"));
}

TEST(MeshReader, skips_a_byte_order_mark)
{
    const std::string mark = "\xEF\xBB\xBF", obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(read("a.off", mark + tetrahedron_off), read("b.off", tetrahedron_off));
    EXPECT_EQ(read("a.obj", mark + obj), read("b.obj", obj));
    for (const auto& format : ply_formats)
        EXPECT_EQ(read("a.ply", mark + stanford_ply(format)), read("b.ply", stanford_ply(format))) << format;
    std::string stl = binary_stl();
    stl.replace(0, mark.size(), mark); // a binary header may hold anything, and keeps its place
    EXPECT_EQ(read("a.stl", stl), read("b.stl", binary_stl()));
    stl.replace(mark.size(), 5, "solid");
    EXPECT_EQ(read("a.stl", stl), read("b.stl", binary_stl()));
    stl.replace(0, 12, std::string("\xFF\xFEsolid\0\0\0\0\0", 12)); // not UTF-16, which is refused
    EXPECT_EQ(read("a.stl", stl), read("b.stl", binary_stl()));
    EXPECT_EQ(read("a.stl", mark + ascii_stl), read("b.stl", ascii_stl));
    expect_error("c.off", mark, {"header", "the file is empty"});
}

TEST(MeshReader, cuts_polygons_into_fans)
{
    const std::vector<std::array<std::uint32_t, 3>> fan = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(read("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles, fan);
    EXPECT_EQ(read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").triangles, fan);
}

TEST(MeshReader, skips_and_counts_faces_that_are_not_polygons)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const MeshSoup& soup : {parse_mesh("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n"),
                                 parse_mesh("a.obj", vertices + "f 1 2\nf 1 2 3\n")}) {
        EXPECT_EQ(soup.notes, std::vector<std::string>{"1 faces of fewer than three corners skipped"});
        EXPECT_EQ(soup.mesh.triangles.size(), 1u);
    }
}

TEST(MeshReader, reads_obj_corners_of_every_form)
{
    const std::string head =
        "# cube\nmtllib a.mtl\no thing\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns off\n";
    const std::vector<std::array<std::uint32_t, 3>> one = {{0, 1, 2}};
    for (const std::string face :
         {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f -3 -2 -1", "f 1 \\\n2 3"})
        EXPECT_EQ(read("a.obj", head + face + "\n").triangles, one) << face;
    EXPECT_EQ(read("a.obj", "f 1 2 3\n" + head).triangles, one) << "a face may come before its vertices";
}

TEST(MeshReader, skips_statements_of_obj_that_it_does_not_know)
{
    const std::string faces = "f 1 2 3\n", vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const MeshSoup soup = parse_mesh("a.obj", vertices + "vc 1 0 0\n" + faces + "vc 0 0 1\n");
    EXPECT_EQ(soup.mesh, read("b.obj", vertices + faces));
    ASSERT_EQ(soup.notes.size(), 1u);
    EXPECT_EQ(soup.notes[0], "2 statements skipped, the first in statement (line 4): 'vc' is not a keyword of OBJ");
    EXPECT_EQ(read("a.obj", "V 0 0 0\nV 1 0 0\nV 0 1 0\nF 1 2 3\n"), soup.mesh);
}

TEST(MeshReader, reads_off_with_every_header)
{
    const std::string rest = tetrahedron_off.substr(4);
    for (const std::string header : {"off\n", "OFF", "OFF ", "", "COFF\n", "NCOFF\n", "STCNOFF\n", "nCoFf\n"})
        EXPECT_EQ(read("a.off", header + rest), read("b.off", tetrahedron_off)) << header;
    for (const std::string header : {"4OFF\n", "nOFF\n", "XOFF\n", "OFFX\n"})
        expect_error("a.off", header + rest, {"header: it begins with '"});
    expect_error("a.off", "off binary\n", {"binary OFF"});
}

TEST(MeshReader, reads_values_that_share_lines)
{
    const std::string off = "OFF\n4 4 6\n0 0 0 1 0 0 0 1 0 0 0 1\n3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2\n";
    EXPECT_EQ(read("a.off", off), read("b.off", tetrahedron_off));
    expect_error("a.off", off.substr(0, off.size() - 3), {"face 3", "the file ends inside it"});
    std::string ply = stanford_ply("ascii");
    const auto body = ply.find("end_header\n") + 11;
    std::replace(ply.begin() + static_cast<std::ptrdiff_t>(body), ply.end(), '\n', ' ');
    EXPECT_EQ(read("a.ply", ply), read("b.ply", stanford_ply("ascii")));
    expect_error("a.ply", ply.substr(0, ply.size() - 3), {"face 1", "the file ends inside it"});
    std::string stl = ascii_stl;
    std::replace(stl.begin(), stl.end(), '\n', ' ');
    EXPECT_EQ(read("a.stl", stl), read("b.stl", ascii_stl));
}

TEST(MeshReader, reads_every_kind_of_line_end)
{
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n";
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"a.obj", obj}, {"a.off", tetrahedron_off}, {"a.stl", ascii_stl}, {"a.ply", stanford_ply("ascii")}})
        for (const std::string end : {"\r", "\r\n"}) {
            std::string changed;
            for (const char c : text)
                changed += c == '\n' ? end : std::string(1, c);
            EXPECT_EQ(read(name, changed), read(name, text)) << name;
        }
    std::string binary = stanford_ply("binary_little_endian");
    std::replace(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(binary.find("end_header\n") + 11), '\n',
                 '\r');
    EXPECT_EQ(read("a.ply", binary), read("b.ply", stanford_ply("ascii")));
}

TEST(MeshReader, tells_the_format_of_a_name_without_extension_by_its_content)
{
    const std::string obj = "# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", keyless = tetrahedron_off.substr(4),
                      two_counts = "4 4" + keyless.substr(keyless.find('\n'));
    for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{{"a.obj", obj},
                                                                                      {"a.off", tetrahedron_off},
                                                                                      {"b.off", "C" + tetrahedron_off},
                                                                                      {"c.off", keyless},
                                                                                      {"d.off", "\n# 1\n" + keyless},
                                                                                      {"e.off", two_counts},
                                                                                      {"a.stl", ascii_stl},
                                                                                      {"b.stl", binary_stl()},
                                                                                      {"a.ply", stanford_ply("ascii")}})
        EXPECT_EQ(read("stdin", bytes), read(name, bytes)) << name;
    expect_error("stdin", "text\n1 2\n", {"'text' is not a keyword of OBJ"});
    for (const std::string line : {"4", "4 4 6 1", "4 4 6.5"})
        expect_error("stdin", line + keyless.substr(keyless.find('\n')), {"'4' is not a keyword of OBJ"});
}

TEST(MeshReader, notes_bytes_after_the_end)
{
    for (const auto& format : ply_formats) {
        const MeshSoup soup = parse_mesh("a.ply", stanford_ply(format) + "\n\x1a\n");
        EXPECT_EQ(soup.mesh, read("b.ply", stanford_ply(format)));
        EXPECT_EQ(soup.notes, std::vector<std::string>{"data after the last announced element were ignored"});
    }
    const MeshSoup off = parse_mesh("a.off", tetrahedron_off + "garbage\n");
    EXPECT_EQ(off.mesh, read("b.off", tetrahedron_off));
    EXPECT_EQ(off.notes, std::vector<std::string>{"text after the last announced face was ignored"});
    const MeshSoup soup = parse_mesh("a.stl", binary_stl() + "by hand");
    EXPECT_EQ(soup.mesh, read("b.stl", binary_stl()));
    EXPECT_EQ(soup.notes, std::vector<std::string>{"7 bytes after the last facet were ignored"});
    EXPECT_EQ(parse_mesh("a.stl", ascii_stl + "\n\n").notes, std::vector<std::string>{});
    for (const std::string more : {"by hand\n", "\x1a", "solid b\nendsolid b\nby hand\nsolid"}) {
        const MeshSoup ascii = parse_mesh("a.stl", ascii_stl + more);
        EXPECT_EQ(ascii.mesh, read("b.stl", ascii_stl)) << more;
        EXPECT_EQ(ascii.notes, std::vector<std::string>{"text after the last endsolid was ignored"}) << more;
    }
    const MeshSoup twice = parse_mesh("a.stl", ascii_stl + ascii_stl);
    EXPECT_EQ(twice.mesh.triangles.size(), 4u);
    EXPECT_TRUE(twice.notes.empty());
}

TEST(MeshReader, reads_ascii_stl_as_programs_write_it)
{
    std::string spaced = ascii_stl;
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"endloop", "end loop"},
                                                                                   {"endfacet", "end facet"},
                                                                                   {"endsolid", "end solid"},
                                                                                   {"a name\n", "a\ncolor 1 0 0\n"}})
        spaced.replace(spaced.find(from), from.size(), to);
    EXPECT_EQ(read("a.stl", spaced), read("b.stl", ascii_stl));
    EXPECT_EQ(read("a.stl", "solid facet vertex" + ascii_stl.substr(ascii_stl.find('\n'))), read("b.stl", ascii_stl));
}

TEST(MeshReader, reads_stanford_ply_in_every_encoding)
{
    const auto ascii = read("a.ply", stanford_ply("ascii"));
    ASSERT_EQ(ascii.vertices.size(), 4u);
    EXPECT_EQ(ascii.vertices[3], (Float3{0.25f, 0.125f, 1}));
    EXPECT_EQ(ascii.triangles[1], (std::array<std::uint32_t, 3>{0, 1, 3}));
    for (const auto& format : ply_formats)
        EXPECT_EQ(read("b.ply", stanford_ply(format)), ascii) << format;
}

TEST(MeshReader, reads_the_triangle_strips_of_ply_with_one_orientation)
{
    const auto strips = [](const std::string& list) {
        return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
               "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n" +
               list + "\n";
    };
    const auto triangles = [&](const std::string& list) { return read("a.ply", strips(list)).triangles; };
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(triangles("5 0 1 2 3 4"), (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
    EXPECT_EQ(triangles("8 0 1 2 -1 2 3 4 5"), (Triangles{{0, 1, 2}, {2, 3, 4}, {4, 3, 5}})) << "two strips";
    EXPECT_EQ(triangles("9 -1 0 1 2 2 2 3 4 -1"), (Triangles{{0, 1, 2}, {2, 3, 4}}))
        << "joined by a polygon that is not a triangle";
    expect_error("a.ply", strips("3 0 1 6"), {"tristrips 0", "index 6 is out of range"});
    expect_error("a.ply", strips("4 0 -1 1 2"), {});
    std::string nameless = strips("3 0 1 2");
    nameless.replace(nameless.find("vertex_indices"), 14, "indices");
    expect_error("a.ply", nameless, {"header", "strips lack the list vertex_indices"});
}

TEST(MeshReader, reads_ply_with_foreign_elements_and_types)
{
    const std::string text =
        "ply\nformat ascii 1.0\nelement camera 1\nproperty list uint8 float64 pose\nelement vertex 3\nproperty float64 "
        "z\n"
        "property double y\nproperty float32 x\nelement face 1\nproperty uchar intensity\nproperty list ushort uint32 "
        "vertex_index\nproperty list uchar float texcoord\nend_header\n2 1.5 2.5\n0 0 1\n0 0 2\n0 1 0\n7 3 0 1 2 2 0 "
        "1\n";
    const auto mesh = read("a.ply", text);
    EXPECT_EQ(mesh.vertices[1], (Float3{2, 0, 0}));
    EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(MeshReader, reads_both_kinds_of_stl)
{
    EXPECT_EQ(read("a.stl", ascii_stl).triangles.size(), 2u);
    EXPECT_EQ(read("a.stl", ascii_stl).vertices[5], (Float3{0, 0, 1.5f}));
    EXPECT_EQ(read("b.stl", binary_stl()).triangles.size(), 2u);
    EXPECT_EQ(read("b.stl", binary_stl()).vertices[5], (Float3{0, 0, 1}));
}

TEST(MeshReader, returns_floats_printed_with_nine_digits_bit_for_bit)
{
    std::mt19937 random(7);
    std::ostringstream off, ply;
    std::vector<Float3> wanted(300);
    off << "OFF\n300 1 0\n";
    ply << "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\nproperty float z\nelement "
           "face 1\n"
           "property list uchar int vertex_indices\nend_header\n";
    for (Float3& v : wanted) {
        for (int axis = 0; axis < 3; ++axis)
            do
                v[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
            while (!std::isfinite(v[axis]));
        char line[100];
        std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", static_cast<double>(v.x), static_cast<double>(v.y),
                      static_cast<double>(v.z));
        off << line;
        ply << line;
    }
    EXPECT_EQ(read("a.off", off.str() + "3 0 1 2\n").vertices, wanted);
    EXPECT_EQ(read("a.ply", ply.str() + "3 0 1 2\n").vertices, wanted);
}

TEST(MeshReader, rounds_decimal_text_only_once)
{
    // Just above the midpoint of two floats: by way of double it would become the midpoint, and then the even float
    // below.
    const auto mesh = read("a.obj", "v 1.00000005960464477539062500001 +1e-60 -2.5E+0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.vertices[0], (Float3{0x1.000002p0f, 0, -2.5f}));
}

TEST(MeshReader, keeps_the_bits_of_coordinates_that_fit_float)
{
    for (const auto& format : ply_formats) {
        const MeshSoup soup = parse_mesh("a.ply", stanford_ply(format));
        EXPECT_EQ(soup.centre, Double3{});
        EXPECT_EQ(soup.rounding, 0);
        EXPECT_EQ(soup.merged_by_rounding, 0u);
    }
    // Far away, but each a float: nothing is lost, so nothing is moved.
    const MeshSoup far = parse_mesh("a.obj", "v 5412350 0 0.5\nv 5412351 0 0.5\nv 5412350 1 0.5\nf 1 2 3\n");
    EXPECT_EQ(far.centre, Double3{});
    EXPECT_EQ(far.mesh.vertices[1], (Float3{5412351, 0, 0.5f}));
    // Ten times as far as the mesh is large: below the limit.
    const MeshSoup near = parse_mesh("a.obj", "v 10.1 0 0\nv 11.1 0 0\nv 10.1 1 0\nf 1 2 3\n");
    EXPECT_EQ(near.centre, Double3{});
    EXPECT_GT(near.rounding, 0);
    EXPECT_LE(near.rounding, max_rounding);
}

TEST(MeshReader, subtracts_the_centre_of_coordinates_that_rounding_would_spoil)
{
    // A triangle of a metre in UTM coordinates, whose floats are half a metre apart; and a vertex that no face has.
    const Double3 centre{451231.75, 5412350.65, 320.7};
    const std::string vertices = "451231.25 5412350.15 320.7\n451232.25 5412350.15 320.7\n451231.25 5412351.15 320.7\n",
                      off = "OFF\n4 1 0\n" + vertices + "0 0 0\n3 0 1 2\n",
                      ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty "
                            "double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                            vertices + "0 0 0\n3 0 1 2\n";
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{{"a.off", off}, {"a.ply", ply}}) {
        const MeshSoup soup = parse_mesh(name, text);
        EXPECT_NEAR(length(soup.centre - centre), 0, 1e-8);
        EXPECT_NEAR(length(to_double(soup.mesh.vertices[0]) - Double3{-0.5, -0.5, 0}), 0, 1e-8);
        EXPECT_NEAR(length(to_double(soup.mesh.vertices[1]) - Double3{0.5, -0.5, 0}), 0, 1e-8);
        EXPECT_LT(soup.rounding, 1e-7);
    }
}

TEST(MeshReader, counts_vertices_that_rounding_merges)
{
    const MeshSoup soup =
        parse_mesh("a.obj", "v 1.000000001 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 0\nf 1 3 4\nf 2 3 4\n");
    EXPECT_EQ(soup.merged_by_rounding, 2u) << "the fifth is at the second's place, but not at the first's";
    EXPECT_NEAR(soup.rounding, 1e-9, 1e-12);
}
