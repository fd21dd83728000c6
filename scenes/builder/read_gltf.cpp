#include "scenes/builder/gltf_values.h"
#include "scenes/builder/read_draco.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Source of the format: Khronos Group, "glTF 2.0 Specification".

namespace tetrace {
namespace {

using Json = nlohmann::json;
using Matrix = std::array<std::array<double, 4>, 3>; // rows; the fourth is 0 0 0 1

constexpr Matrix identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

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
Matrix matrix_of(const GltfFile& file, const Json& node, const std::string& place)
{
    Matrix m = identity;
    if (const auto matrix = file.numbers(node, "matrix", 16, place); !matrix.empty()) {
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                m[row][column] = matrix[4 * column + row];
        return m;
    }
    if (const auto rotation = file.numbers(node, "rotation", 4, place); !rotation.empty()) {
        const double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
        m = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
              {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
              {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    }
    const auto scale = file.numbers(node, "scale", 3, place), translation = file.numbers(node, "translation", 3, place);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; !scale.empty() && column < 3; ++column)
            m[row][column] *= scale[column];
        if (!translation.empty()) m[row][3] = translation[row];
    }
    return m;
}

// The triangles of a primitive; empty of points and lines.
std::vector<std::array<std::size_t, 3>> triangles_of(const MeshSource& source, std::uint64_t mode, std::size_t corners,
                                                     const std::string& place)
{
    std::vector<std::array<std::size_t, 3>> triangles;
    const bool is_strip = mode == 5, is_fan = mode == 6;
    if (is_strip || is_fan) {
        for (std::size_t i = 2; i < corners; ++i)
            triangles.push_back(is_fan ? std::array{std::size_t{0}, i - 1, i}
                                       : std::array{i - 2 + i % 2, i - 1 - i % 2, i});
    } else if (mode == 4) {
        if (corners % 3 != 0) source.fail(place, fmt::format("its {} corners are not three a triangle", corners));
        for (std::size_t i = 0; i < corners; i += 3)
            triangles.push_back({i, i + 1, i + 2});
    }
    return triangles;
}

// What is not finite stays as it is, to be refused by its own coordinate.
Double3 placed(const Matrix& matrix, Double3 at)
{
    if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) return at;
    const auto coordinate = [&](std::size_t row) {
        return matrix[row][0] * at.x + matrix[row][1] * at.y + matrix[row][2] * at.z + matrix[row][3];
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

constexpr std::size_t max_vertices = std::size_t{1} << 28;

// Adds the vertices and triangles of primitives.
class Primitives {
public:
    Primitives(MeshSource& source, GltfFile& file) : source_(source), file_(file) {}

    void add(const Json& primitive, const Matrix& matrix, const std::string& place)
    {
        const Json& attributes = member(primitive, "attributes");
        if (member(attributes, "POSITION").is_null()) return;
        const std::uint64_t positions = file_.integer(attributes, "POSITION", {}, place);
        const Json& draco = extension(primitive, "KHR_draco_mesh_compression");
        const bool has_plain =
            !member(file_.element("accessors", positions, place, "accessor"), "bufferView").is_null();
        if (draco.is_null() || has_plain)
            add_plain(primitive, positions, matrix, place);
        else
            add_draco(draco, matrix, place);
    }

private:
    void add_plain(const Json& primitive, std::uint64_t accessor, const Matrix& matrix, const std::string& place)
    {
        const GltfValues positions(file_, accessor, 3, place + ", positions");
        add_vertices(positions.count(), matrix, place, [&](std::size_t i) {
            return Double3{positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)};
        });
        std::optional<GltfValues> indices;
        if (!member(primitive, "indices").is_null())
            indices.emplace(file_, file_.integer(primitive, "indices", {}, place), 1, place + ", indices");
        if (indices && !indices->has_whole_numbers()) source_.fail(place, "its indices are not whole numbers");
        const std::uint64_t mode = file_.integer(primitive, "mode", 4, place);
        const std::size_t corners = indices ? indices->count() : positions.count();
        for (const auto& triangle : triangles_of(source_, mode, corners, place)) {
            std::array<std::size_t, 3> vertices{};
            for (std::size_t i = 0; i < 3; ++i) {
                const double index = indices ? indices->at(triangle[i], 0) : static_cast<double>(triangle[i]);
                if (!(index >= 0 && index < static_cast<double>(positions.count())))
                    source_.fail(place,
                                 fmt::format("corner {} names vertex {} of {}", triangle[i], index, positions.count()));
                vertices[i] = static_cast<std::size_t>(index);
            }
            add_triangle(vertices, positions.count(), matrix, place);
        }
    }
    void add_draco(const Json& draco, const Matrix& matrix, const std::string& place)
    {
        const std::uint64_t attribute = file_.integer(member(draco, "attributes"), "POSITION", {}, place);
        const std::uint64_t view = file_.integer(draco, "bufferView", {}, place);
        const DracoMesh mesh = read_draco(source_, file_.view(view, 0, place), attribute, place);
        add_vertices(mesh.positions.size(), matrix, place, [&](std::size_t i) { return mesh.positions[i]; });
        for (const std::array<std::size_t, 3>& triangle : mesh.triangles)
            add_triangle(triangle, mesh.positions.size(), matrix, place);
    }
    template <class Position>
    void add_vertices(std::size_t count, const Matrix& matrix, const std::string& place, const Position& position)
    {
        if (count > max_vertices - source_.vertex_count()) // nodes may name the same mesh again and again
            source_.fail(place, fmt::format("with all its nodes the file has more than {} vertices", max_vertices));
        for (std::size_t i = 0; i < count; ++i)
            source_.add_vertex(placed(matrix, position(i)), fmt::format("{}, vertex {}", place, i));
    }
    // Of the vertices that were added last.
    void add_triangle(std::array<std::size_t, 3> triangle, std::size_t count, const Matrix& matrix,
                      const std::string& place)
    {
        if (determinant(matrix) < 0) std::swap(triangle[1], triangle[2]);
        std::vector<std::int64_t> face;
        for (const std::size_t vertex : triangle)
            face.push_back(static_cast<std::int64_t>(source_.vertex_count() - count + vertex));
        source_.add_face(face, source_.vertex_count(), place);
    }

    MeshSource& source_;
    GltfFile& file_;
};

// The numbers in a list of an object.
std::vector<std::uint64_t> indices_of(const GltfFile& file, const Json& object, const char* key,
                                      const std::string& place)
{
    std::vector<std::uint64_t> indices;
    for (const Json& index : member(object, key)) {
        if (!index.is_number_unsigned())
            file.source().fail(place, fmt::format("its {} are not all whole numbers", key));
        indices.push_back(index.get<std::uint64_t>());
    }
    return indices;
}

// The nodes that the file shows: those of its scene, or all without a parent.
std::vector<std::uint64_t> roots_of(const GltfFile& file)
{
    if (!file.list("scenes").empty()) {
        const std::uint64_t scene = file.integer(file.root(), "scene", 0, "file");
        return indices_of(file, file.element("scenes", scene, "file", "scene"), "nodes", "scene");
    }
    const Json& nodes = file.list("nodes");
    std::vector<bool> is_child(nodes.size(), false);
    for (const Json& node : nodes)
        for (const std::uint64_t child : indices_of(file, node, "children", "file"))
            if (child < is_child.size()) is_child[static_cast<std::size_t>(child)] = true;
    std::vector<std::uint64_t> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(i);
    return roots;
}

bool is_hidden(const Json& node)
{
    return member(extension(node, "KHR_node_visibility"), "visible") == false;
}

void add_mesh(GltfFile& file, Primitives& primitives, const Json& node, const Matrix& matrix, const std::string& place)
{
    if (!extension(node, "EXT_mesh_gpu_instancing").is_null())
        file.source().fail(place, "it uses the extension EXT_mesh_gpu_instancing, which is not read",
                           "export it again with a node for each instance");
    const std::uint64_t number = file.integer(node, "mesh", {}, place);
    const Json& list = member(file.element("meshes", number, place, "mesh"), "primitives");
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i)
        primitives.add(list[i], matrix, fmt::format("{}, mesh {}, primitive {}", place, number, i));
}

} // namespace

void read_gltf(MeshSource& source)
{
    GltfFile file(source);
    Primitives primitives(source, file);
    std::vector<std::pair<std::uint64_t, Matrix>> open;
    for (const std::uint64_t root : roots_of(file))
        open.emplace_back(root, identity);
    std::reverse(open.begin(), open.end());
    std::vector<bool> seen(file.list("nodes").size(), false);
    while (!open.empty()) {
        const auto [index, outer] = open.back();
        open.pop_back();
        const std::string place = fmt::format("node {}", index);
        const Json& node = file.element("nodes", index, place, "node");
        if (seen[static_cast<std::size_t>(index)]) source.fail(place, "it is reached by two ways");
        seen[static_cast<std::size_t>(index)] = true;
        if (is_hidden(node)) continue;
        const Matrix matrix = product(outer, matrix_of(file, node, place));
        const std::vector<std::uint64_t> children = indices_of(file, node, "children", place);
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            open.emplace_back(*child, matrix);
        if (!member(node, "mesh").is_null()) add_mesh(file, primitives, node, matrix, place);
    }
}

} // namespace tetrace
