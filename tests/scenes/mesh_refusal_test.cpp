// Mesh files that are refused, by file, place and problem; and damaged ones, which are read or refused.
#include "tests/scenes/mesh_samples.h"

#include <cmath>
#include <random>

using namespace tetrace;
using namespace tetrace::test;

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

TEST(MeshRefusal, distinguishes_a_missing_file_from_a_bad_one)
{
    const TemporaryFolder folder;
    const std::string error = error_of([&] { (void)read_mesh(folder / "none.off"); });
    EXPECT_TRUE(error.starts_with("missing: ")) << error;
    EXPECT_TRUE(contains(error, "none.off"));
    EXPECT_THROW((void)read_mesh(folder.path()), Error);
}

TEST(MeshRefusal, names_empty_files_and_unknown_formats)
{
    for (const std::string name : {"a.off", "a.obj", "a.ply", "a.stl"})
        expect_error(name, "", {"empty"});
    expect_error("a.fbx", "glTF", {"'.fbx' is not known", ".ply, .obj, .off, .stl, .glb or .gltf"});
    expect_error("a.off", "ply\n", {"begins with 'ply'", "extension"});
    expect_error("a.ply", tetrahedron_off, {"does not begin with 'ply'"});
    expect_error("a.obj", tetrahedron_off, {"'OFF' is not a keyword", "line 1"});
    expect_error("a.obj", "text\nmore text\n", {"'text' is not a keyword", "line 1"});
    expect_error("a.stl", tetrahedron_off, {"neither"});
    for (const std::string mark : {"\xFF\xFE", "\xFE\xFF"})
        for (const std::string name : {"a.obj", "a.off", "a.ply", "stdin"})
            expect_error(name, mark + std::string("v\0 \0", 4), {"UTF-16", "iconv -f UTF-16 -t UTF-8"});
    std::string little = "\xFF\xFE", big = "\xFE\xFF";
    for (const char c : ascii_stl)
        little += {c, '\0'}, big += {'\0', c};
    for (const std::string& text : {little, big})
        for (const std::string name : {"a.stl", "stdin"})
            expect_error(name, text, {"UTF-16", "iconv -f UTF-16 -t UTF-8"});
    for (const std::string name : {"a.obj", "a.ply", "a.stl", "a.ply.gz", "a.glb", "a.vtu", "stdin"})
        expect_error(name, "\x1F\x8B\x08" + std::string(20, '\0'),
                     {"file: it is compressed by gzip", "zcat FILE | tetrace build --scene /dev/stdin"});
    expect_error("a.off", "OFF BINARY\n", {"binary OFF", "convert"});
}

TEST(MeshRefusal, names_meshes_without_geometry)
{
    expect_error("a.off", "OFF\n0 0 0\n", {"lacks vertices"});
    expect_error("a.off", "OFF\n1 0 0\n1 2 3\n", {"lacks triangles"});
    expect_error("a.obj", "v 1 2 3\n", {"lacks triangles"});
    expect_error("a.stl", "solid a\nendsolid a\n", {"lacks vertices"});
}

TEST(MeshRefusal, names_the_vertex_that_is_no_finite_float)
{
    for (const auto& [value, problem] : std::vector<std::pair<std::string, std::string>>{
             {"nan", "not a number"}, {"-inf", "infinite"}, {"1e39", "outside float"}, {"1e400", "outside float"}}) {
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
    expect_error("a.obj", "v 0,5 0 0\n", {"vertex 1 (line 1)", "'0,5' has a comma", "decimal point"});
    expect_error("a.off", "OFF\n3 1 0\n0, 0, 0\n", {"vertex 0 (line 3)", "'0,' has a comma"});
    expect_error("a.obj", "v 0 0\n", {"vertex 1 (line 1)", "fewer than three coordinates"});
    expect_error("a.obj", "v 1,2,3\n", {"vertex 1 (line 1)", "'1,2,3' has a comma", "nothing between them but blanks"});
    expect_error("a.off", "OFF\n3 1 0\n-1.5,2,3e4,\n", {"vertex 0 (line 3)", "'-1.5,2,3e4,' has a comma"});
    for (const std::string word : {",", "1,two", "1;2"})
        expect_error("a.obj", "v " + word + " 0 0\n", {"'" + word + "' is not a number"});
    std::string ply = stanford_ply("ascii");
    ply.replace(ply.find("0.25"), 4, "0,25");
    expect_error("a.ply", ply, {"vertex 3", "'0,25' has a comma"});
}

TEST(MeshRefusal, names_the_type_of_ply_that_is_not_read)
{
    const std::string whole = stanford_ply("ascii");
    for (const auto& [from, type] : std::vector<std::pair<std::string, std::string>>{
             {"float x", "float16 x"}, {"uchar int", "uchar int64"}, {"uchar int", "uint64 int"}}) {
        std::string ply = whole;
        ply.replace(ply.find(from), from.size(), type);
        const std::string error = refusal_of("a.ply", ply);
        EXPECT_TRUE(contains(error, "header (line "));
        EXPECT_TRUE(contains(error, "' is not read; export the mesh again, with integers as int"));
        EXPECT_FALSE(contains(error, "damaged")) << error;
    }
}

TEST(MeshRefusal, names_the_face_with_an_index_out_of_range)
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

TEST(MeshRefusal, refuses_counts_that_the_file_cannot_hold)
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
TEST(MeshRefusal, refuses_elements_without_properties_and_cuts_long_names)
{
    const std::string end = "end_header\n", big = "ply\nformat binary_little_endian 1.0\nelement nothing 70\n" + end;
    expect_error("a.ply", big + std::string(70, ' '), {"header", "announces 70 elements 'nothing' without properties"});
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement nothing 3\n" + end + "\n\n\n", {"without properties"});
    const std::string none = "ply\nformat ascii 1.0\nelement nothing 0\n" + stanford_ply("ascii").substr(21);
    EXPECT_EQ(parse_mesh("a.ply", none).mesh, parse_mesh("b.ply", stanford_ply("ascii")).mesh);
    const std::string named = "ply\nformat ascii 1.0\nelement " + std::string(9000, 'e') + " 3\nproperty int x\n" + end;
    EXPECT_LT(refusal_of("a.ply", named + "1\nx\n").size(), 400u);
}

TEST(MeshRefusal, quotes_a_file_without_its_escapes)
{
    expect_error("a.obj", "\x1b[2J\xff 1 2 3\n", {"'?[2J?' is not a keyword"});
    expect_error("a.off", "OFF\x1b]0;x\x07\n", {"it begins with 'OFF?]0;x?'"});
    const std::string named = error_of([] { (void)parse_mesh("a\x1b[2J\n.obj", "v 0 0\n"); });
    EXPECT_TRUE(named.starts_with("invalid_input: ")) << named;
    EXPECT_EQ(named.find_first_of("\x1b\n"), std::string::npos) << named;
}

TEST(MeshRefusal, refuses_files_cut_short_and_files_too_long)
{
    expect_error("a.off", tetrahedron_off.substr(0, 30), {"vertex"});
    expect_error("a.off", tetrahedron_off.substr(0, tetrahedron_off.size() - 8), {"face 3", "ends before"});
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", {"lacks triangles"});
    expect_error("a.stl", ascii_stl.substr(0, ascii_stl.size() - 40), {"facet 1"});
    expect_error("a.stl", ascii_stl.substr(0, ascii_stl.size() - 17), {"endsolid"});
    expect_error("a.stl", ascii_stl + "more\n" + ascii_stl, {"facet 2 (line 17)", "'more' where 'solid' should come"});
    expect_error("a.stl", ascii_stl + ascii_stl.substr(ascii_stl.find("facet")), {"'facet' where 'solid' should come"});
    expect_error("a.stl", "solid a\nendsolid a\nmore\n", {"'more' where 'solid' should come"});
    expect_error("b.stl", binary_stl().substr(0, 150), {"the file has 150"});
    expect_error("b.stl", binary_stl(1), {"announces 1 facets", "enough for 2"});
    expect_error("b.stl", binary_stl(0), {"announces 0 facets", "enough for 2"});
    for (const auto& format : ply_formats) {
        const std::string whole = stanford_ply(format);
        expect_error("a.ply", whole.substr(0, whole.size() - 5), {"face 1"});
        expect_error("a.ply", stanford_ply(format, "3"), {}); // a vertex too many shifts the rest
    }
}

TEST(MeshRefusal, survives_every_truncation_and_seeded_byte_flips)
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
