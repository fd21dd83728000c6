// glTF and GLB: what the file shows, in place; and what is refused.
#include "core/base/error.h"
#include "scenes/builder/mesh_reader.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/random.h"

#include <cstring>
#include <fmt/format.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

template <class Value>
void put(std::string& bytes, Value value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A .glb of JSON and binary data, both padded to four bytes.
std::string glb(std::string json, std::string data)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string bytes = "glTF";
    put(bytes, 2u);
    put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
    put(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    put(bytes, static_cast<std::uint32_t>(data.size()));
    return bytes + std::string("BIN\0", 4) + data;
}

/// The tetrahedron's corners and, at byte 48, its indices of 16 bits.
std::string tetrahedron_data()
{
    const TriangleMesh mesh = tetrahedron();
    std::string data;
    for (const Float3 v : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis)
            put(data, v[axis]);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            put(data, static_cast<std::uint16_t>(corner));
    return data;
}

/// One mesh, of that data, shown by these nodes (the first is the scene's root). more: further keys of the file.
std::string json_of(const std::string& nodes, const std::string& primitive = R"("indices":1)",
                    const std::string& more = "")
{
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},{}}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)"
        R"("min":[0,0,0],"max":[1,1,1]}},)"
        R"({{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],)"
        R"("buffers":[{{"byteLength":72}}]{}}})",
        nodes, primitive, more);
}

MeshSoup read(const std::string& bytes, const std::string& name = "a.glb")
{
    return parse_mesh(name, bytes);
}

std::string refusal(const std::string& bytes, const std::string& name = "a.glb")
{
    return error_of([&] { (void)read(bytes, name); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    text.replace(text.find(from), from.size(), to);
    return text;
}

class Gltf : public testing::Test {
protected:
    void SetUp() override
    {
        if (contains(refusal(plain_), "built without tinygltf")) GTEST_SKIP() << "tetrace-builder does not read glTF";
    }

    std::string plain_ = glb(json_of(R"({"mesh":0})"), tetrahedron_data());
};

} // namespace

TEST(NoGltf, is_reported_with_its_package)
{
    const std::string text = refusal("glTF");
    EXPECT_TRUE(contains(text, "invalid_input: reading a.glb: ")) << text;
    if (contains(text, "built without tinygltf")) {
        EXPECT_TRUE(contains(text, "install libtinygltf-dev"));
    }
}

TEST_F(Gltf, gives_the_same_triangles_as_any_other_format)
{
    const MeshSoup soup = read(plain_);
    EXPECT_EQ(soup.mesh, tetrahedron());
    EXPECT_EQ(read(plain_, "a.GLB").mesh, tetrahedron());
    EXPECT_NE(soup.source_hash, 0u);
}

TEST_F(Gltf, reads_json_with_its_data_inside)
{
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::string data = tetrahedron_data();
    std::string base64;
    for (std::size_t i = 0; i < data.size(); i += 3) { // 72 bytes: no rest
        const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(data[i + k])); };
        const unsigned word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (const unsigned shift : {18u, 12u, 6u, 0u})
            base64 += digits[word >> shift & 63];
    }
    const std::string json = replaced(json_of(R"({"mesh":0})"), R"("byteLength":72)",
                                      R"("byteLength":72,"uri":"data:application/octet-stream;base64,)" + base64 + '"');
    EXPECT_EQ(read(json, "a.gltf").mesh, tetrahedron());
    const std::string outside =
        replaced(json_of(R"({"mesh":0})"), R"("byteLength":72)", R"("byteLength":72,"uri":"/etc/passwd")");
    EXPECT_TRUE(contains(refusal(outside, "a.gltf"), "a buffer is in another file; export it as .glb"));
}

TEST_F(Gltf, puts_meshes_where_their_nodes_are)
{
    const auto vertices = [&](const std::string& nodes) {
        return read(glb(json_of(nodes), tetrahedron_data())).mesh.vertices;
    };
    EXPECT_EQ(vertices(R"({"mesh":0,"translation":[1,2,3],"scale":[2,2,4]})"),
              (std::vector<Float3>{{1, 2, 3}, {3, 2, 3}, {1, 4, 3}, {1, 2, 7}}));
    EXPECT_EQ(vertices(R"({"mesh":0,"rotation":[0,0,1,0]})"),
              (std::vector<Float3>{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}))
        << "half a turn";
    EXPECT_EQ(vertices(R"({"mesh":0,"matrix":[0,1,0,0, 0,0,1,0, 1,0,0,0, 5,6,7,1]})"),
              (std::vector<Float3>{{5, 6, 7}, {5, 7, 7}, {5, 6, 8}, {6, 6, 7}}));
    const auto twice = vertices(R"({"scale":[2,2,2],"children":[1,2]},{"mesh":0,"translation":[1,0,0]},{"mesh":0})");
    ASSERT_EQ(twice.size(), 8u) << "a mesh of two nodes is there twice";
    EXPECT_EQ(twice[0], (Float3{2, 0, 0}));
    EXPECT_EQ(twice[5], (Float3{2, 0, 0}));
    const MeshSoup mirrored = read(glb(json_of(R"({"mesh":0,"scale":[-1,1,1]})"), tetrahedron_data()));
    EXPECT_EQ(mirrored.mesh.triangles.front(), (std::array<std::uint32_t, 3>{0, 1, 2})) << "still outwards";
}

TEST_F(Gltf, reads_strips_fans_and_triangles_without_indices)
{
    const auto triangles = [&](const std::string& primitive) {
        const std::string four = replaced(json_of(R"({"mesh":0})", primitive), R"("count":12)", R"("count":4)");
        std::string data = tetrahedron_data();
        for (std::uint16_t i = 0; i < 4; ++i)
            std::memcpy(data.data() + 48 + 2 * i, &i, sizeof i);
        return read(glb(four, data)).mesh.triangles;
    };
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(triangles(R"("mode":5,"indices":1)"), (Triangles{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(triangles(R"("mode":6,"indices":1)"), (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangles(R"("mode":5)"), (Triangles{{0, 1, 2}, {2, 1, 3}}));
}

TEST_F(Gltf, refuses_what_it_would_read_wrongly)
{
    const auto refused = [&](const std::string& from, const std::string& to) {
        return refusal(glb(replaced(json_of(R"({"mesh":0})"), from, to), tetrahedron_data()));
    };
    EXPECT_TRUE(contains(refused(R"("buffers")", R"("extensionsUsed":["KHR_draco_mesh_compression"],"buffers")"),
                         "the extension KHR_draco_mesh_compression, which is not read; export it again as .glb"));
    EXPECT_TRUE(contains(refused(R"("count":4)", R"("count":5)"), "5 elements are more than its buffer holds"));
    EXPECT_TRUE(contains(refused(R"("count":4)", R"("count":18446744073709551615)"), "more than its buffer"));
    EXPECT_TRUE(contains(refused(R"("count":4)", R"("count":2)"), "names vertex 2 of 2"));
    EXPECT_TRUE(contains(refused(R"("count":12)", R"("count":11)"), "11 corners are not three a triangle"));
    EXPECT_TRUE(contains(refused(R"("byteOffset":48)", R"("byteOffset":50)"), "longer than its buffer"));
    EXPECT_TRUE(contains(refused(R"("bufferView":0)", R"("bufferView":7)"), "it names buffer view 7 of 2"));
    EXPECT_TRUE(contains(refused(R"("POSITION":0)", R"("POSITION":9)"), "it names accessor 9 of 2"));
    EXPECT_TRUE(contains(refused(R"("mesh":0)", R"("mesh":3)"), "it names mesh 3 of 1"));
    EXPECT_TRUE(contains(refused(R"("componentType":5123,"count":12)", R"("componentType":5126,"count":6)"),
                         "not whole numbers"));
    EXPECT_TRUE(contains(refused(R"("mesh":0)", R"("mesh":0,"children":[0])"), "reached by two ways"));
    EXPECT_TRUE(contains(refused(R"("indices":1)", R"("mode":0)"), "it lacks triangles")) << "points";
    EXPECT_TRUE(contains(refused(R"("version":"2.0")", R"("verson":"2.0")"), "reading a.glb"));
    std::string nan = tetrahedron_data();
    nan.replace(4, 4, "\xff\xff\xff\xff");
    EXPECT_TRUE(contains(refusal(glb(json_of(R"({"mesh":0})"), nan)), "vertex 0: coordinate y is not a number"));
    const std::string deep = std::string(100000, '[') + std::string(100000, ']');
    EXPECT_TRUE(contains(refused(R"("buffers")", R"("extras":)" + deep + R"(,"buffers")"), "levels deep"));
}

TEST_F(Gltf, survives_every_truncation_and_seeded_byte_flips)
{
    const auto try_to_read = [](const std::string& bytes) {
        try {
            const MeshSoup soup = read(bytes);
            for (const auto& triangle : soup.mesh.triangles)
                for (const std::uint32_t corner : triangle)
                    ASSERT_LT(corner, soup.mesh.vertices.size());
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
        }
    };
    for (std::size_t length = 0; length < plain_.size(); ++length)
        EXPECT_NE(refusal(plain_.substr(0, length)), "") << length;
    Random random(19);
    for (int i = 0; i < 3000; ++i) {
        std::string bytes = plain_;
        for (std::uint32_t flips = 1 + random.below(3); flips > 0; --flips)
            bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
        try_to_read(bytes);
    }
}
