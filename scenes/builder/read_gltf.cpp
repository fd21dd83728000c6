#include "scenes/builder/mesh_source.h"

// tinygltf parses the JSON and the chunks; pictures are not decoded, and no other file is opened. What the accessors
// say is checked here.
#include <fstream> // which tinygltf does not include if it opens no files
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

// Source of the format: Khronos Group, "glTF 2.0 Specification".

namespace tetrace {
namespace {

using Matrix = std::array<std::array<double, 4>, 3>; // rows; the fourth is 0 0 0 1
constexpr const char* export_plainly = "export it again as .glb, without compression";
constexpr int deepest = 256; // of JSON: tinygltf follows it by recursion

// At most so deep as tinygltf may be given it. Binary chunks are looked at too, harmlessly: a false alarm there would
// take hundreds of brackets more of one kind than of the other, so only the JSON chunk counts.
void require_shallow(const MeshSource& source, std::string_view json)
{
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (c == '"') quoted = !quoted;
        if (quoted && c == '\\') ++i;
        if (quoted) continue;
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
        if (depth > deepest) source.fail("header", fmt::format("its JSON is more than {} levels deep", deepest));
    }
}

std::string_view json_chunk(std::string_view glb)
{
    std::uint32_t length = 0;
    if (glb.size() < 20) return {};
    std::memcpy(&length, glb.data() + 12, sizeof length); // little endian, as all that this program runs on
    return glb.substr(20, length);
}

tinygltf::Model parse(const MeshSource& source)
{
    const std::string_view bytes = source.bytes();
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
        source.fail("file", "it has more than 4 GiB", "glTF cannot hold more: simplify the mesh, or use PLY");
    const auto size = static_cast<unsigned>(bytes.size());
    const bool is_binary = bytes.starts_with("glTF");
    require_shallow(source, is_binary ? json_chunk(bytes) : bytes);
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                             void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string errors, warnings;
    bool good = false;
    try {
        good = is_binary ? reader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                       reinterpret_cast<const unsigned char*>(bytes.data()), size)
                         : reader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size, "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& unexpected) {
        errors = unexpected.what();
    }
    if (errors.find("FS callback") != std::string::npos)
        source.fail("buffers", "a buffer is in another file", "export it as .glb, which holds all in one file");
    if (!good) source.fail("header", errors.empty() ? "it is not glTF 2.0" : errors.substr(0, 300));
    return model;
}

// What changes the geometry, and is not read.
void require_plain(const MeshSource& source, const tinygltf::Model& model)
{
    for (const char* const extension :
         {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"}) {
        const auto& used = model.extensionsUsed;
        if (std::find(used.begin(), used.end(), extension) != used.end())
            source.fail("header", fmt::format("it uses the extension {}, which is not read", extension),
                        export_plainly);
    }
    // A reader has to refuse what it does not know; these say nothing of where triangles are, or only of their numbers.
    for (const std::string& extension : model.extensionsRequired)
        if (extension != "KHR_mesh_quantization" && extension != "KHR_lights_punctual" &&
            !extension.starts_with("KHR_materials_") && !extension.starts_with("KHR_texture_"))
            source.fail("header", fmt::format("it requires the extension {}, which is not read", extension),
                        export_plainly);
}

// An element of a list that an index of the file names; throws where there is none.
template <class Element>
const Element& element_at(const MeshSource& source, const std::vector<Element>& list, int index,
                          const std::string& place, const char* what)
{
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        source.fail(place, fmt::format("it names {} {} of {}", what, index, list.size()));
    return list[static_cast<std::size_t>(index)];
}

// The values of an accessor, checked to lie in its buffer.
class Values {
public:
    Values(const MeshSource& source, const tinygltf::Model& model, int index, int type, std::string place)
    {
        const tinygltf::Accessor& accessor = element_at(source, model.accessors, index, place, "accessor");
        if (accessor.sparse.isSparse) source.fail(place, "its accessor is sparse, which is not read", export_plainly);
        if (accessor.type != type) source.fail(place, fmt::format("accessor {} is of another type", index));
        const auto& view = element_at(source, model.bufferViews, accessor.bufferView, place, "buffer view");
        const auto& buffer = element_at(source, model.buffers, view.buffer, place, "buffer");
        component_ = accessor.componentType;
        normalized_ = accessor.normalized;
        const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_));
        if (bytes <= 0) source.fail(place, fmt::format("component type {} is none of glTF", component_));
        size_ = static_cast<std::size_t>(bytes);
        const std::size_t element =
            size_ * static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
        stride_ = view.byteStride == 0 ? element : view.byteStride;
        count_ = accessor.count;
        std::size_t room = buffer.data.size();
        for (const auto& [offset, length] :
             {std::pair(view.byteOffset, view.byteLength), std::pair(accessor.byteOffset, std::size_t{0})}) {
            if (offset > room || length > room - offset)
                source.fail(place, "its buffer view is longer than its buffer");
            room = length > 0 ? length : room - offset;
        }
        if (count_ > 0 && (element > room || count_ - 1 > (room - element) / stride_))
            source.fail(place, fmt::format("{} elements are more than its buffer holds", count_));
        data_ = buffer.data.data() + view.byteOffset + accessor.byteOffset;
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] int component_type() const { return component_; }
    [[nodiscard]] double at(std::size_t element, std::size_t component) const
    {
        const unsigned char* const from = data_ + element * stride_ + component * size_;
        switch (component_) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return static_cast<double>(read<float>(from));
        case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled<std::int8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled<std::uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled<std::int16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled<std::uint16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read<std::uint32_t>(from);
        default: return std::numeric_limits<double>::quiet_NaN(); // refused as a coordinate and as an index
        }
    }

private:
    template <class Value>
    static Value read(const unsigned char* from)
    {
        Value value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }
    template <class Value>
    [[nodiscard]] double scaled(const unsigned char* from) const
    {
        const double value = read<Value>(from);
        return normalized_ ? std::max(value / std::numeric_limits<Value>::max(), -1.0) : value;
    }

    const unsigned char* data_ = nullptr;
    std::size_t count_ = 0, stride_ = 0, size_ = 0;
    int component_ = 0;
    bool normalized_ = false;
};

Matrix product(const Matrix& a, const Matrix& b)
{
    Matrix result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            result[row][column] = column == 3 ? a[row][3] : 0;
            for (std::size_t k = 0; k < 3; ++k)
                result[row][column] += a[row][k] * b[k][column];
        }
    return result;
}

double determinant(const Matrix& m)
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

// As a matrix by columns, or as scale, rotation (a quaternion) and translation, in this order.
Matrix matrix_of(const tinygltf::Node& node)
{
    Matrix m = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    if (node.matrix.size() == 16) {
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                m[row][column] = node.matrix[4 * column + row];
        return m;
    }
    if (node.rotation.size() == 4) {
        const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
        m = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
              {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
              {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    }
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; node.scale.size() == 3 && column < 3; ++column)
            m[row][column] *= node.scale[column];
        if (node.translation.size() == 3) m[row][3] = node.translation[row];
    }
    return m;
}

// The triangles of a primitive; empty of points and lines.
std::vector<std::array<std::size_t, 3>> triangles_of(const MeshSource& source, int mode, std::size_t corners,
                                                     const std::string& place)
{
    std::vector<std::array<std::size_t, 3>> triangles;
    const bool is_strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP, is_fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (is_strip || is_fan) {
        for (std::size_t i = 2; i < corners; ++i)
            triangles.push_back(is_fan ? std::array{std::size_t{0}, i - 1, i}
                                       : std::array{i - 2 + i % 2, i - 1 - i % 2, i});
    } else if (mode == TINYGLTF_MODE_TRIANGLES || mode == -1) {
        if (corners % 3 != 0) source.fail(place, fmt::format("its {} corners are not three a triangle", corners));
        for (std::size_t i = 0; i < corners; i += 3)
            triangles.push_back({i, i + 1, i + 2});
    }
    return triangles;
}

// What is not finite stays as it is, to be refused by its own coordinate.
Float3 placed(const Matrix& matrix, const Values& positions, std::size_t i)
{
    const Double3 at{positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)};
    if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) return to_float(at);
    const auto coordinate = [&](std::size_t row) {
        return matrix[row][0] * at.x + matrix[row][1] * at.y + matrix[row][2] * at.z + matrix[row][3];
    };
    return to_float(Double3{coordinate(0), coordinate(1), coordinate(2)});
}

constexpr std::size_t max_vertices = std::size_t{1} << 28;

void add_primitive(MeshSource& source, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                   const Matrix& matrix, const std::string& place)
{
    const auto attribute = primitive.attributes.find("POSITION");
    if (attribute == primitive.attributes.end()) return;
    const Values positions(source, model, attribute->second, TINYGLTF_TYPE_VEC3, place + ", positions");
    const std::size_t first = source.soup().mesh.vertices.size();
    if (positions.count() > max_vertices - first) // nodes may name the same mesh again and again
        source.fail(place, fmt::format("with all its nodes the file has more than {} vertices", max_vertices));
    for (std::size_t i = 0; i < positions.count(); ++i)
        source.add_vertex(placed(matrix, positions, i), fmt::format("{}, vertex {}", place, i));
    std::optional<Values> indices;
    if (primitive.indices >= 0)
        indices.emplace(source, model, primitive.indices, TINYGLTF_TYPE_SCALAR, place + ", indices");
    if (indices && indices->component_type() == TINYGLTF_COMPONENT_TYPE_FLOAT)
        source.fail(place, "its indices are not whole numbers");
    const bool is_mirrored = determinant(matrix) < 0;
    const std::size_t corners = indices ? indices->count() : positions.count();
    for (auto triangle : triangles_of(source, primitive.mode, corners, place)) {
        if (is_mirrored) std::swap(triangle[1], triangle[2]);
        std::vector<std::int64_t> face;
        for (const std::size_t corner : triangle) {
            const double index = indices ? indices->at(corner, 0) : static_cast<double>(corner);
            if (!(index >= 0 && index < static_cast<double>(positions.count())))
                source.fail(place, fmt::format("corner {} names vertex {} of {}", corner, index, positions.count()));
            face.push_back(static_cast<std::int64_t>(first) + static_cast<std::int64_t>(index));
        }
        source.add_face(face, source.soup().mesh.vertices.size(), place);
    }
}

// The nodes that the file shows: those of its scene, or all without a parent.
std::vector<int> roots_of(const MeshSource& source, const tinygltf::Model& model)
{
    if (!model.scenes.empty())
        return element_at(source, model.scenes, std::max(model.defaultScene, 0), "file", "scene").nodes;
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

} // namespace

void read_gltf(MeshSource& source)
{
    const tinygltf::Model model = parse(source);
    require_plain(source, model);
    std::vector<std::pair<int, Matrix>> open;
    for (const int root : roots_of(source, model))
        open.emplace_back(root, matrix_of({}));
    std::reverse(open.begin(), open.end());
    std::vector<bool> seen(model.nodes.size(), false);
    while (!open.empty()) {
        const auto [index, outer] = open.back();
        open.pop_back();
        const std::string place = fmt::format("node {}", index);
        const tinygltf::Node& node = element_at(source, model.nodes, index, place, "node");
        if (seen[static_cast<std::size_t>(index)]) source.fail(place, "it is reached by two ways");
        seen[static_cast<std::size_t>(index)] = true;
        const Matrix matrix = product(outer, matrix_of(node));
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            open.emplace_back(*child, matrix);
        if (node.mesh < 0) continue;
        const tinygltf::Mesh& mesh = element_at(source, model.meshes, node.mesh, place, "mesh");
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i)
            add_primitive(source, model, mesh.primitives[i], matrix,
                          fmt::format("node {}, mesh {}, primitive {}", index, node.mesh, i));
    }
}

} // namespace tetrace
