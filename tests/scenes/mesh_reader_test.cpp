// What is read from mesh files of every format. What is refused: mesh_refusal_test.cpp.
#include "tests/scenes/mesh_samples.h"

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
    expect_error("c.off", mark, {"header", "the file is empty"});
}

TEST(MeshReader, cuts_polygons_into_fans)
{
    const std::vector<std::array<std::uint32_t, 3>> fan = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(read("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles, fan);
    EXPECT_EQ(read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").triangles, fan);
}

TEST(MeshReader, cuts_polygons_that_are_not_convex_without_overlap)
{
    // An arrowhead, whose fan from the first corner would lie outside it; in each plane, and turned both ways.
    const double corners[4][2] = {{0, 0}, {2, 1}, {4, 0}, {2, 4}}, area = 6;
    for (int axis = 0; axis < 3; ++axis) {
        for (const std::string order : {"0 1 2 3", "3 2 1 0", "2 3 0 1"}) {
            std::string text = "OFF\n4 1 0\n";
            for (const auto& [x, y] : corners) {
                double at[3] = {0.125 * x, 0.125 * x, 0.125 * x};
                at[(axis + 1) % 3] = x, at[(axis + 2) % 3] = y;
                for (const double coordinate : at)
                    text += std::to_string(coordinate) + " ";
                text += "\n";
            }
            const TriangleMesh mesh = read("a.off", text + "4 " + order + "\n");
            ASSERT_EQ(mesh.triangles.size(), 2u);
            double sum = 0, signs = 0;
            for (const auto& [a, b, c] : mesh.triangles) {
                const Double3 p = to_double(mesh.vertices[a]);
                const Double3 normal = cross(to_double(mesh.vertices[b]) - p, to_double(mesh.vertices[c]) - p);
                const double part = axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z;
                sum += std::abs(part) / 2;
                signs += part < 0 ? -1 : 1;
            }
            EXPECT_DOUBLE_EQ(sum, area) << axis << ", " << order;
            EXPECT_EQ(std::abs(signs), 2) << "both are turned as the polygon is";
        }
    }
    // A comb of many teeth.
    std::string comb = "OFF\n202 1 0\n0 -1 0\n", face = "202 0";
    for (int i = 0; i <= 200; ++i) {
        comb += std::to_string(200 - i) + (i % 2 == 0 ? " 0 0\n" : " 9 0\n");
        face += " " + std::to_string(i + 1);
    }
    double sum = 0;
    const TriangleMesh teeth = read("a.off", comb + face + "\n");
    for (const auto& [a, b, c] : teeth.triangles) {
        const Double3 p = to_double(teeth.vertices[a]);
        const Double3 normal = cross(to_double(teeth.vertices[b]) - p, to_double(teeth.vertices[c]) - p);
        EXPECT_GE(normal.z, 0);
        sum += normal.z / 2;
    }
    EXPECT_NEAR(sum, 100 + 900, 1e-6);
}

TEST(MeshReader, counts_faces_that_are_no_polygons)
{
    const TemporaryFolder folder;
    write_file(folder / "a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n");
    const auto soup = read_mesh(folder / "a.off");
    EXPECT_EQ(soup.skipped_faces, 1u);
    EXPECT_EQ(soup.mesh.triangles.size(), 1u);
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
