// glTF and GLB: what the file shows, in place; and what is refused.
#include "core/base/error.h"
#include "scenes/builder/mesh_reader.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/random.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
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

/// The tetrahedron by `draco_encoder -qp 0 -cl 0`.
std::string tetrahedron_draco()
{
    constexpr std::string_view hex =
        "445241434f02020100000004040100010200020302010300030101010009030000000000000000000000000000000000"
        "00000000803f000000000000803f000000000000000000000000000000000000803f";
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        unsigned char byte = 0;
        std::from_chars(hex.data() + i, hex.data() + i + 2, byte, 16);
        bytes += static_cast<char>(byte);
    }
    return bytes;
}

/// The corners' places of each triangle, each from its smallest on, sorted.
std::vector<std::array<std::array<float, 3>, 3>> triangles_in_place(const TriangleMesh& mesh)
{
    std::vector<std::array<std::array<float, 3>, 3>> list;
    for (const auto& triangle : mesh.triangles) {
        auto& corners = list.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = {mesh.vertices[triangle[i]].x, mesh.vertices[triangle[i]].y, mesh.vertices[triangle[i]].z};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    std::sort(list.begin(), list.end());
    return list;
}

MeshSoup read_gltf(const std::string& bytes, const std::string& name = "a.glb")
{
    return parse_mesh(name, bytes);
}

std::string refusal(const std::string& bytes, const std::string& name = "a.glb")
{
    return error_of([&] { (void)read_gltf(bytes, name); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    text.replace(text.find(from), from.size(), to);
    return text;
}

class Gltf : public testing::Test {
protected:
    /// The plain file with a change of its JSON.
    [[nodiscard]] static std::string changed(const std::string& from, const std::string& to)
    {
        return glb(replaced(json_of(R"({"mesh":0})"), from, to), tetrahedron_data());
    }

    std::string plain_ = glb(json_of(R"({"mesh":0})"), tetrahedron_data());
};

} // namespace

TEST_F(Gltf, gives_the_same_triangles_as_any_other_format)
{
    const MeshSoup soup = read_gltf(plain_);
    EXPECT_EQ(soup.mesh, tetrahedron());
    EXPECT_EQ(read_gltf(plain_, "a.GLB").mesh, tetrahedron());
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
    EXPECT_EQ(read_gltf(json, "a.gltf").mesh, tetrahedron());
}

TEST_F(Gltf, reads_buffers_in_files_of_the_same_folder)
{
    const TemporaryFolder folder;
    const auto json = [&](const std::string& uri) {
        return replaced(json_of(R"({"mesh":0})"), R"("byteLength":72)", R"("byteLength":72,"uri":")" + uri + '"');
    };
    const auto read_beside = [&](const std::string& uri) {
        write_file(folder / "a.gltf", json(uri));
        return read_mesh(folder / "a.gltf");
    };
    const auto refusal_beside = [&](const std::string& uri) { return error_of([&] { (void)read_beside(uri); }); };
    write_file(folder / "my box+1.bin", tetrahedron_data() + "more than the buffer's length");
    const MeshSoup soup = read_beside("my%20box+1.bin");
    EXPECT_EQ(soup.mesh, tetrahedron());
    std::string other = tetrahedron_data();
    other[60] ^= 1;
    write_file(folder / "my box+1.bin", other);
    EXPECT_NE(read_beside("my%20box+1.bin").source_hash, soup.source_hash) << "the buffer is part of the mesh";

    std::filesystem::create_directory(folder / "sub");
    write_file(folder / "sub/box.bin", tetrahedron_data());
    write_file(folder / "short.bin", tetrahedron_data().substr(1));
    for (const std::string uri : {"sub/box.bin", "sub%2Fbox.bin", "../box.bin", "/etc/passwd", "..", "", "a%00b"})
        EXPECT_TRUE(contains(refusal_beside(uri), "is not a file of the same folder; export it as .glb")) << uri;
    EXPECT_TRUE(contains(refusal_beside("none.bin"), "none.bin' cannot be read; copy it into the folder"));
    EXPECT_TRUE(contains(refusal_beside("sub"), "cannot be read"));
    EXPECT_TRUE(contains(refusal_beside("short.bin"), "buffer 0 has 71 bytes, not 72"));
    EXPECT_TRUE(contains(refusal(json("my%20box+1.bin"), "a.gltf"), "is not a file of the same folder"))
        << "bytes in memory are in no folder";
    // A buffer that no triangle needs may be missing.
    write_file(folder / "a.gltf",
               replaced(json("short.bin"), R"("buffers":[)", R"("buffers":[{"byteLength":9,"uri":"none.bin"},)"));
    EXPECT_TRUE(contains(error_of([&] { (void)read_mesh(folder / "a.gltf"); }), "none.bin"));
    write_file(folder / "short.bin", tetrahedron_data());
    write_file(folder / "a.gltf", replaced(json("short.bin"), R"("uri":"short.bin"})",
                                           R"("uri":"short.bin"},{"byteLength":9,"uri":"none.bin"})"));
    EXPECT_EQ(read_mesh(folder / "a.gltf").mesh, tetrahedron());
}

TEST_F(Gltf, reads_sparse_accessors)
{
    // Vertex 3 is moved to (7, 8, 9), by two more buffer views; and the same from zeros, without a view.
    std::string data = tetrahedron_data();
    put(data, std::uint32_t{3});
    for (const float x : {7.0f, 8.0f, 9.0f})
        put(data, x);
    const auto sparse = [&](const std::string& index, const std::string& base = R"("bufferView":0,)") {
        std::string json = replaced(json_of(R"({"mesh":0})"), R"({"buffer":0,"byteOffset":48,"byteLength":24})",
                                    R"({"buffer":0,"byteOffset":48,"byteLength":24},{"buffer":0,"byteOffset":72,)"
                                    R"("byteLength":4},{"buffer":0,"byteOffset":76,"byteLength":12})");
        json = replaced(json, R"("byteLength":72)", R"("byteLength":88)");
        json = replaced(json, R"("min":[0,0,0])",
                        R"("sparse":{"count":1,"indices":{"bufferView":2,"componentType":)" + index +
                            R"(},"values":{"bufferView":3}},"min":[0,0,0])");
        return glb(replaced(json, R"("bufferView":0,)", base), data);
    };
    EXPECT_EQ(read_gltf(sparse("5125")).mesh.vertices,
              (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 8, 9}}));
    EXPECT_EQ(read_gltf(sparse("5121", "")).mesh.vertices,
              (std::vector<Float3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {7, 8, 9}}));
    EXPECT_TRUE(contains(refusal(sparse("5126")), "sparse indices"));
    data.replace(72, 1, "\4");
    EXPECT_TRUE(
        contains(refusal(sparse("5125")), "entry 0 of its sparse indices, 4, does not rise, or is not below 4"));
    EXPECT_TRUE(contains(refusal(changed(R"("bufferView":0,)", "")), "accessor 0 has no data"));
}

TEST_F(Gltf, looks_at_version_and_required_extensions_first)
{
    EXPECT_TRUE(contains(refusal(changed(R"("version":"2.0")", R"("version":"1.0")")),
                         "it is glTF 1.0, which is not read; convert it to glTF 2.0"));
    EXPECT_TRUE(contains(refusal(R"({"asset":{"version":"1.1"},"meshes":{"a":{}}})", "a.gltf"), "it is glTF 1.1"));
    const auto at_least = [&](const std::string& version) {
        return changed(R"("version":"2.0")", R"("version":"2.0","minVersion":)" + version);
    };
    for (const std::string version : {"2.1", "2.10", "3.0", "10.0"})
        EXPECT_TRUE(contains(refusal(at_least('"' + version + '"')),
                             "it requires glTF " + version + " (asset.minVersion), which is not read; export it as"));
    EXPECT_TRUE(contains(refusal(at_least("[2]")), "it requires glTF [2]"));
    for (const std::string version : {"\"2.0\"", "\"1.0\"", "null"})
        EXPECT_EQ(read_gltf(at_least(version)).mesh, read_gltf(plain_).mesh);
    std::string first = plain_;
    first[4] = 1;
    EXPECT_TRUE(contains(refusal(first), "it is glTF 1.0"));
    const auto required = [&](const std::string& name) {
        return changed(R"("buffers")", R"("extensionsRequired":[")" + name + R"("],"buffers")");
    };
    for (const std::string name :
         {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif", "VRM", "KHR_xmp_json_ld",
          "KHR_materials_variants", "KHR_node_visibility", "MSFT_lod", "KHR_animation_pointer",
          "EXT_lights_image_based", "KHR_mesh_quantization"})
        EXPECT_EQ(read_gltf(required(name)).mesh, tetrahedron()) << name;
    for (const std::string name : {"CESIUM_RTC", "EXT_meshopt_compression", "KHR_draco_mesh_compressionX", "VRMX"})
        EXPECT_TRUE(contains(refusal(required(name)),
                             "it requires the extension " + name + ", which is not read; export it again as .glb"));
}

TEST_F(Gltf, honours_extensions_of_nodes)
{
    const auto node = [](const std::string& what) { return glb(json_of(what), tetrahedron_data()); };
    const std::string hidden = R"({"mesh":0,"children":[1]},{"extensions":{"KHR_node_visibility":{"visible":false}},)"
                               R"("mesh":0,"children":[2]},{"mesh":0})";
    EXPECT_EQ(read_gltf(node(hidden)).mesh, tetrahedron()) << "a hidden node hides its children";
    EXPECT_TRUE(contains(refusal(node(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}}})")),
                         "node 0: it uses the extension EXT_mesh_gpu_instancing"));
    EXPECT_EQ(read_gltf(changed(R"("buffers")", R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"buffers")")).mesh,
              tetrahedron());
}

TEST_F(Gltf, reads_draco_or_names_its_package)
{
    // The same tetrahedron by draco_encoder, as the only buffer view; and together with plain accessors.
    const std::string draco = tetrahedron_draco();
    const std::string use =
        R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}},)";
    std::string json = replaced(json_of(R"({"mesh":0})", use + R"("indices":1)"), R"("bufferView":0,"componentType")",
                                R"("componentType")");
    json = replaced(json, R"("bufferView":1,"componentType")", R"("componentType")");
    json =
        replaced(json, R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}])",
                 fmt::format(R"("bufferViews":[{{"buffer":0,"byteLength":{}}}])", draco.size()));
    json = replaced(json, R"("byteLength":72)", fmt::format(R"("byteLength":{})", draco.size()));
    if (const std::string error = refusal(glb(json, draco)); error.empty()) {
        const TriangleMesh mesh = read_gltf(glb(json, draco)).mesh;
        EXPECT_EQ(triangles_in_place(mesh), triangles_in_place(tetrahedron()));
        const std::string damaged = glb(json, std::string(draco.size(), 'x'));
        EXPECT_TRUE(contains(refusal(damaged), "its Draco data cannot be read"));
        const std::string other = glb(replaced(json, R"({"POSITION":0}}})", R"({"POSITION":7}}})"), draco);
        EXPECT_TRUE(contains(refusal(other), "lack the attribute 7"));
    } else {
        EXPECT_TRUE(contains(error, "install libdraco-dev")) << error;
    }
    EXPECT_EQ(read_gltf(glb(json_of(R"({"mesh":0})", use + R"("indices":1)"), tetrahedron_data())).mesh, tetrahedron())
        << "plain accessors are read where they are there";
}

TEST_F(Gltf, puts_meshes_where_their_nodes_are)
{
    const auto vertices = [&](const std::string& nodes) {
        return read_gltf(glb(json_of(nodes), tetrahedron_data())).mesh.vertices;
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
    const MeshSoup mirrored = read_gltf(glb(json_of(R"({"mesh":0,"scale":[-1,1,1]})"), tetrahedron_data()));
    EXPECT_EQ(mirrored.mesh.triangles.front(), (std::array<std::uint32_t, 3>{0, 1, 2})) << "still outwards";
}

TEST_F(Gltf, reads_strips_fans_and_triangles_without_indices)
{
    const auto triangles = [&](const std::string& primitive) {
        const std::string four = replaced(json_of(R"({"mesh":0})", primitive), R"("count":12)", R"("count":4)");
        std::string data = tetrahedron_data();
        for (std::uint16_t i = 0; i < 4; ++i)
            std::memcpy(data.data() + 48 + 2 * i, &i, sizeof i);
        return read_gltf(glb(four, data)).mesh.triangles;
    };
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(triangles(R"("mode":5,"indices":1)"), (Triangles{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(triangles(R"("mode":6,"indices":1)"), (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangles(R"("mode":5)"), (Triangles{{0, 1, 2}, {2, 1, 3}}));
}

TEST_F(Gltf, refuses_what_it_would_read_wrongly)
{
    const auto refused = [&](const std::string& from, const std::string& to) { return refusal(changed(from, to)); };
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
    EXPECT_TRUE(contains(refused(R"("version":"2.0")", R"("verson":"2.0")"), "it lacks asset.version"));
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
            const MeshSoup soup = read_gltf(bytes);
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
