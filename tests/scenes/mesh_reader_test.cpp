#include "core/base/error.h"
#include "scenes/builder/mesh_reader.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <unistd.h>

using namespace tetrace;

namespace {

const std::string tetrahedron_off = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

class MeshReader : public testing::Test {
protected:
    MeshReader()
        : folder_(std::filesystem::temp_directory_path() / ("tetrace-mesh-reader-" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(folder_);
    }
    ~MeshReader() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    TriangleMesh read(const std::string& name, const std::string& bytes) const
    {
        return read_mesh(write(name, bytes)).mesh;
    }

    // The text of the error, which must be of the kind and name the file.
    std::string error_of(const std::string& name, const std::string& bytes) const
    {
        try {
            const auto soup = read_mesh(write(name, bytes));
            ADD_FAILURE() << name << " was read: " << soup.mesh.triangles.size() << " triangles";
            return "";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            return error.what();
        }
    }
    void expect_error(const std::string& name, const std::string& bytes, const std::vector<std::string>& parts) const
    {
        const std::string text = error_of(name, bytes);
        for (const auto& part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
    }

    std::filesystem::path folder_;
};

// One value as the bytes of either order.
template <class Value>
std::string bytes_of(Value value, bool little)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return little == (std::endian::native == std::endian::little) ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

// A triangle pair as Stanford writes it: extra vertex properties, lists of int behind a byte.
std::string stanford_ply(const std::string& format, const std::string& vertices = "4", const std::string& faces = "2",
                         int last_index = 3, float last_x = 0.25f)
{
    std::string text =
        "ply\nformat " + format + " 1.0\ncomment zipper output\nobj_info num_cols 512\nelement vertex " + vertices +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty float confidence\nproperty float "
        "intensity\nelement face " +
        faces + "\nproperty list uchar int vertex_indices\nend_header\n";
    const float x[4][5] = {{0, 0, 0, 1, 0.5f}, {1, 0, 0, 1, 0.5f}, {0, 1, 0, 1, 0.5f}, {last_x, 0.125f, 1, 1, 0.5f}};
    const int index[2][3] = {{0, 1, 2}, {0, 1, last_index}};
    const bool ascii = format == "ascii";
    const bool little = format == "binary_little_endian";
    std::ostringstream body;
    for (const auto& row : x) {
        for (const float value : row)
            ascii ? (body << value << ' ') : (body << bytes_of(value, little));
        if (ascii) body << '\n';
    }
    for (const auto& row : index) {
        ascii ? (body << "3 ") : (body << '\3');
        for (const int value : row)
            ascii ? (body << value << ' ') : (body << bytes_of(value, little));
        if (ascii) body << '\n';
    }
    return text + body.str();
}

std::string binary_stl(std::uint32_t announced = 2, float first = 0)
{
    std::string text(80, ' ');
    text.replace(0, 5, "solid"); // some programs begin binary files so
    text += bytes_of(announced, true);
    const float x[2][12] = {{0, 0, 1, first, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (const auto& facet : x) {
        for (const float value : facet)
            text += bytes_of(value, true);
        text += std::string(2, '\0');
    }
    return text;
}

const std::string ascii_stl =
    "solid a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
    "  endloop\n endfacet\n FACET NORMAL nan 0 0\n  OUTER LOOP\n   VERTEX 0 0 0\n   VERTEX 0 1 0\n   VERTEX "
    "0 0 1.5e0\n  ENDLOOP\n ENDFACET\nendsolid a name\n";

const std::vector<std::string> ply_formats = {"ascii", "binary_little_endian", "binary_big_endian"};

} // namespace

TEST_F(MeshReader, reads_off_with_comments_and_colours)
{
    const auto plain = read("a.off", tetrahedron_off);
    EXPECT_EQ(plain.vertices.size(), 4u);
    EXPECT_EQ(plain.triangles[3], (std::array<std::uint32_t, 3>{0, 3, 2}));
    EXPECT_EQ(
        read("b.off",
             "COFF # colours\n3 1 0\n\n0 0 0 255 0 0 255\n# between\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2 9 9 9\n"),
        read("c.OFF", "NOFF 3 1 0\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 0 0 0 1\r\n3 0 1 2\r\n"));
}

TEST_F(MeshReader, skips_a_byte_order_mark)
{
    const std::string mark = "\xEF\xBB\xBF", obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(read("a.off", mark + tetrahedron_off), read("b.off", tetrahedron_off));
    EXPECT_EQ(read("a.obj", mark + obj), read("b.obj", obj));
    for (const auto& format : ply_formats)
        EXPECT_EQ(read("a.ply", mark + stanford_ply(format)), read("b.ply", stanford_ply(format))) << format;
    std::string stl = binary_stl();
    stl.replace(0, mark.size(), mark); // a binary header may hold anything, and keeps its place
    EXPECT_EQ(read("a.stl", stl), read("b.stl", binary_stl()));
    expect_error("c.off", mark, {"header", "no text"});
}

TEST_F(MeshReader, cuts_polygons_into_fans)
{
    const std::vector<std::array<std::uint32_t, 3>> fan = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(read("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles, fan);
    EXPECT_EQ(read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").triangles, fan);
}

TEST_F(MeshReader, cuts_polygons_that_are_not_convex_without_overlap)
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

TEST_F(MeshReader, counts_faces_that_are_no_polygons)
{
    const auto soup = read_mesh(write("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n"));
    EXPECT_EQ(soup.skipped_faces, 1u);
    EXPECT_EQ(soup.mesh.triangles.size(), 1u);
}

TEST_F(MeshReader, reads_obj_corners_of_every_form)
{
    const std::string head =
        "# cube\nmtllib a.mtl\no thing\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns off\n";
    const std::vector<std::array<std::uint32_t, 3>> one = {{0, 1, 2}};
    for (const std::string face :
         {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f -3 -2 -1", "f 1 \\\n2 3"})
        EXPECT_EQ(read("a.obj", head + face + "\n").triangles, one) << face;
    EXPECT_EQ(read("a.obj", "f 1 2 3\n" + head).triangles, one) << "a face may come before its vertices";
}

TEST_F(MeshReader, reads_stanford_ply_in_every_encoding)
{
    const auto ascii = read("a.ply", stanford_ply("ascii"));
    ASSERT_EQ(ascii.vertices.size(), 4u);
    EXPECT_EQ(ascii.vertices[3], (Float3{0.25f, 0.125f, 1}));
    EXPECT_EQ(ascii.triangles[1], (std::array<std::uint32_t, 3>{0, 1, 3}));
    for (const auto& format : ply_formats)
        EXPECT_EQ(read("b.ply", stanford_ply(format)), ascii) << format;
}

TEST_F(MeshReader, reads_the_triangle_strips_of_ply_with_one_orientation)
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
    EXPECT_EQ(triangles("9 -1 0 1 2 2 2 3 4 -1"), (Triangles{{0, 1, 2}, {2, 3, 4}})) << "joined by what is no triangle";
    expect_error("a.ply", strips("3 0 1 6"), {"tristrips 0", "index 6 is out of range"});
    expect_error("a.ply", strips("4 0 -1 1 2"), {});
    std::string nameless = strips("3 0 1 2");
    nameless.replace(nameless.find("vertex_indices"), 14, "indices");
    expect_error("a.ply", nameless, {"header", "strips lack the list vertex_indices"});
}

TEST_F(MeshReader, reads_ply_with_foreign_elements_and_types)
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

TEST_F(MeshReader, reads_both_kinds_of_stl)
{
    EXPECT_EQ(read("a.stl", ascii_stl).triangles.size(), 2u);
    EXPECT_EQ(read("a.stl", ascii_stl).vertices[5], (Float3{0, 0, 1.5f}));
    EXPECT_EQ(read("b.stl", binary_stl()).triangles.size(), 2u);
    EXPECT_EQ(read("b.stl", binary_stl()).vertices[5], (Float3{0, 0, 1}));
}

TEST_F(MeshReader, returns_floats_printed_with_nine_digits_bit_for_bit)
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

TEST_F(MeshReader, rounds_decimal_text_only_once)
{
    // Just above the midpoint of two floats: by way of double it would become the midpoint, and then the even float
    // below.
    const auto mesh = read("a.obj", "v 1.00000005960464477539062500001 +1e-60 -2.5E+0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.vertices[0], (Float3{0x1.000002p0f, 0, -2.5f}));
}

TEST_F(MeshReader, tells_a_missing_file_from_a_bad_one)
{
    try {
        static_cast<void>(read_mesh(folder_ / "none.off"));
        FAIL() << "a missing file was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::missing);
        EXPECT_NE(std::string(error.what()).find("none.off"), std::string::npos);
    }
    EXPECT_THROW(static_cast<void>(read_mesh(folder_)), Error);
}

TEST_F(MeshReader, names_empty_files_and_unknown_formats)
{
    for (const std::string name : {"a.off", "a.obj", "a.ply", "a.stl"})
        expect_error(name, "", {"empty"});
    expect_error("a.fbx", "glTF", {"'.fbx' is not known", ".ply, .obj, .off, .stl, .glb or .gltf"});
    expect_error("a.off", "ply\n", {"begins with 'ply'", "extension"});
    expect_error("a.ply", tetrahedron_off, {"does not begin with 'ply'"});
    expect_error("a.obj", tetrahedron_off, {"'OFF' is no keyword", "line 1"});
    expect_error("a.stl", tetrahedron_off, {"neither"});
    expect_error("a.off", "OFF BINARY\n", {"binary OFF", "convert"});
}

TEST_F(MeshReader, names_meshes_without_geometry)
{
    expect_error("a.off", "OFF\n0 0 0\n", {"no vertices"});
    expect_error("a.off", "OFF\n1 0 0\n1 2 3\n", {"no triangles"});
    expect_error("a.obj", "v 1 2 3\n", {"no triangles"});
    expect_error("a.stl", "solid a\nendsolid a\n", {"no vertices"});
}

TEST_F(MeshReader, names_the_vertex_that_is_no_finite_float)
{
    for (const auto& [value, problem] : std::vector<std::pair<std::string, std::string>>{
             {"nan", "not a number"}, {"-inf", "infinite"}, {"1e39", "beyond float"}, {"1e400", "beyond float"}}) {
        expect_error("a.off", "OFF\n3 1 0\n0 0 0\n0 " + value + " 0\n0 1 0\n3 0 1 2\n",
                     {"vertex 1 (line 4)", "coordinate y", problem});
        expect_error("a.obj", "v 0 0 0\nv 0 0 " + value + "\n", {"vertex 2 (line 2)", "coordinate z", problem});
        expect_error("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex " + value + " 0 0\n",
                     {"facet 0 (line 4)", "coordinate x", problem});
    }
    for (const auto& format : ply_formats) {
        expect_error("a.ply", stanford_ply(format, "4", "2", 3, NAN), {"vertex 3", "coordinate x is not a number"});
        expect_error("a.ply", stanford_ply(format, "4", "2", 3, INFINITY), {"vertex 3", "coordinate x is infinite"});
    }
    expect_error("b.stl", binary_stl(2, NAN), {"facet 0, vertex 0", "not a number"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n0 zero 0\n", {"vertex 1 (line 4)", "'zero' is not a number"});
}

TEST_F(MeshReader, names_the_face_with_an_index_out_of_range)
{
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", {"face 0 (line 6)", "index 3 is out of range"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
                 {"face 0 (line 6)", "index -1 is out of range"});
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expect_error("a.obj", vertices + "f 1 2 4\n", {"face 1 (line 4)", "out of range"});
    expect_error("a.obj", vertices + "f -4 -2 -1\n", {"face 1 (line 4)", "out of range"});
    expect_error("a.obj", vertices + "f 0 1 2\n", {"face 1 (line 4)", "counted from 1"});
    for (const auto& format : ply_formats)
        for (const int index : {4, -1, 1 << 30})
            expect_error("a.ply", stanford_ply(format, "4", "2", index), {"face 1", "out of range"});
}

TEST_F(MeshReader, refuses_counts_that_the_file_cannot_hold)
{
    for (const std::string count : {"4000000000", "-4", "9223372036854775807"}) {
        expect_error("a.off", "OFF\n" + count + " 1 0\n0 0 0\n", {"header", "vertices"});
        expect_error("a.off", "OFF\n1 " + count + " 0\n0 0 0\n", {"header", "faces"});
        for (const auto& format : ply_formats) {
            expect_error("a.ply", stanford_ply(format, count), {"header", "'vertex'"});
            expect_error("a.ply", stanford_ply(format, "4", count), {"header", "'face'"});
        }
    }
    expect_error("b.stl", binary_stl(4000000000u), {"announces 4000000000 facets"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", {"corners"});
}

// Nothing of the file is read for such an element, so that its size bounds neither their number nor the time.
TEST_F(MeshReader, refuses_elements_without_properties_and_cuts_long_names)
{
    const std::string end = "end_header\n", big = "ply\nformat binary_little_endian 1.0\nelement nothing 70\n" + end;
    expect_error("a.ply", big + std::string(70, ' '), {"header", "announces 70 elements 'nothing' without properties"});
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement nothing 3\n" + end + "\n\n\n", {"without properties"});
    const std::string none = "ply\nformat ascii 1.0\nelement nothing 0\n" + stanford_ply("ascii").substr(21);
    EXPECT_EQ(read("a.ply", none).triangles.size(), read("b.ply", stanford_ply("ascii")).triangles.size());
    const std::string named = "ply\nformat ascii 1.0\nelement " + std::string(9000, 'e') + " 3\nproperty int x\n" + end;
    EXPECT_LT(error_of("a.ply", named + "1\nx\n").size(), 400u);
}

TEST_F(MeshReader, quotes_a_file_without_its_escapes)
{
    expect_error("a.obj", "\x1b[2J\xff 1 2 3\n", {"'?[2J?' is no keyword"});
    expect_error("a.off", "OFF\x1b]0;x\x07\n", {"it begins with 'OFF?]0;x?'"});
    try {
        (void)read_mesh(write("a\x1b[2J\n.obj", "v 0 0\n"));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find_first_of("\x1b\n"), std::string::npos) << error.what();
    }
}

TEST_F(MeshReader, refuses_files_cut_short_and_files_too_long)
{
    expect_error("a.off", tetrahedron_off.substr(0, 30), {"vertex"});
    expect_error("a.off", tetrahedron_off.substr(0, tetrahedron_off.size() - 8), {"face 3", "ends before"});
    expect_error("a.off", tetrahedron_off + "garbage\n", {"follows the last announced face"});
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", {"face 1 (line 4)", "fewer than three"});
    expect_error("a.stl", ascii_stl.substr(0, ascii_stl.size() - 40), {"facet 1"});
    expect_error("a.stl", ascii_stl.substr(0, ascii_stl.size() - 17), {"endsolid"});
    expect_error("b.stl", binary_stl().substr(0, 150), {"the file has 150"});
    expect_error("b.stl", binary_stl() + "x", {"announces 2 facets"});
    for (const auto& format : ply_formats) {
        const std::string whole = stanford_ply(format);
        expect_error("a.ply", whole.substr(0, whole.size() - 5), {"face 1"});
        expect_error("a.ply", stanford_ply(format, "3"), {}); // a vertex too many shifts the rest
        expect_error("a.ply", whole + "garbage", {"follow the last announced element"});
    }
}

namespace {

void expect_valid_or_error(const std::string& name, const std::string& bytes)
{
    try {
        const MeshSoup soup = parse_mesh(name, bytes);
        for (const Float3 v : soup.mesh.vertices)
            ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
        for (const auto& triangle : soup.mesh.triangles)
            for (const auto vertex : triangle)
                ASSERT_LT(vertex, soup.mesh.vertices.size());
        ASSERT_FALSE(soup.mesh.triangles.empty());
    } catch (const Error& error) {
        ASSERT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
    }
}

} // namespace

TEST_F(MeshReader, survives_every_truncation_and_seeded_byte_flips)
{
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.off", tetrahedron_off},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2 3//1 -1\n"},
        {"a.ply", stanford_ply("ascii")},
        {"b.ply", stanford_ply(ply_formats[1])},
        {"c.ply", stanford_ply(ply_formats[2])},
        {"a.stl", ascii_stl},
        {"b.stl", binary_stl()}};
    constexpr unsigned seed = 20;
    std::mt19937 random(seed);
    for (const auto& [name, bytes] : files) {
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            SCOPED_TRACE(name + " cut to " + std::to_string(size));
            expect_valid_or_error(name, bytes.substr(0, size));
        }
        for (int flip = 0; flip < 1000; ++flip) {
            std::string damaged = bytes;
            for (auto count = 1 + random() % 3; count > 0; count--)
                damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
            SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", flip " + std::to_string(flip));
            expect_valid_or_error(name, damaged);
        }
    }
}
