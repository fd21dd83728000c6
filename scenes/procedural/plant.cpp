// A plant: thin, open leaves that cross each other and the stem, so that it has to be repaired before it has tets.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tetrace {

namespace {

constexpr std::uint32_t leaves = 120;
constexpr double height = 10;

double radius_of_stem(double share)
{
    return 0.25 * (1 - 0.9 * share);
}

/// A closed prism of six sides, tapering, along the y axis.
void add_stem(MeshBuilder& mesh, std::uint32_t segments)
{
    constexpr double half = 0.5, rise = 0.8660254037844386;
    constexpr std::array<std::array<double, 2>, 6> around = {
        {{1, 0}, {half, -rise}, {-half, -rise}, {-1, 0}, {-half, rise}, {half, rise}}};
    std::vector<std::uint32_t> last;
    for (std::uint32_t ring = 0; ring <= segments; ++ring) {
        const double share = static_cast<double>(ring) / segments;
        std::vector<std::uint32_t> vertices;
        for (const auto& [x, z] : around)
            vertices.push_back(mesh.vertex({x * radius_of_stem(share), height * share, z * radius_of_stem(share)}));
        if (ring > 0) mesh.strip(last, vertices, true);
        if (ring == 0 || ring == segments) {
            const std::uint32_t centre = mesh.vertex({0, height * share, 0});
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const std::uint32_t next = vertices[(i + 1) % vertices.size()];
                mesh.triangle(centre, ring == 0 ? next : vertices[i], ring == 0 ? vertices[i] : next);
            }
        }
        last = vertices;
    }
}

/// A leaf that begins inside the stem, bends down and is folded along its midrib.
struct Leaf {
    Double3 root, along, side;
    double size, droop;

    /// share: of its length; across: -1, 0 and 1 are an edge, the midrib and the other edge.
    [[nodiscard]] Double3 at(double share, double across) const
    {
        const double width = 0.9 * share * (1 - share) * (1.5 - share);
        const Double3 up{0, size * (0.25 * width * across * across - droop * share * share), 0};
        return root + along * (size * share) + side * (size * width * across) + up;
    }
};

/// 4 columns (rows - 1) triangles; columns: on each side of the midrib.
void add_leaf(MeshBuilder& mesh, const Leaf& leaf, std::uint32_t columns, std::uint32_t rows)
{
    std::vector<std::uint32_t> last;
    for (std::uint32_t row = 1; row < rows; ++row) {
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t column = 0; column <= 2 * columns; ++column)
            vertices.push_back(
                mesh.vertex(leaf.at(static_cast<double>(row) / rows, static_cast<double>(column) / columns - 1)));
        if (row > 1) mesh.strip(last, vertices, false);
        for (const bool is_tip : {false, true}) {
            if (row != (is_tip ? rows - 1 : 1)) continue;
            const std::uint32_t end = mesh.vertex(leaf.at(is_tip ? 1 : 0, 0));
            for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
                mesh.triangle(vertices[is_tip ? i : i + 1], vertices[is_tip ? i + 1 : i], end);
        }
        last = vertices;
    }
}

} // namespace

TriangleMesh make_plant(std::uint32_t triangles)
{
    const double in_leaf = static_cast<double>(triangles) / leaves;
    const auto columns = static_cast<std::uint32_t>(std::max(1L, std::lround(std::sqrt(in_leaf / 16))));
    const auto rows = static_cast<std::uint32_t>(std::lround(in_leaf / (4 * columns))) + 1;
    MeshBuilder mesh;
    add_stem(mesh, rows);
    constexpr double cosine = -0.7373688780783198, sine = 0.6754902942615239; // of the golden angle
    double x = 1, z = 0;
    for (std::uint32_t i = 0; i < leaves; ++i) {
        const double turned = x * cosine - z * sine;
        z = x * sine + z * cosine;
        x = turned;
        const auto random = [&](std::uint32_t stream) { return 2 * random_unit(stream, i) - 1; };
        const double share = 0.1 + 0.88 * (i + 0.5) / leaves, inside = 0.7 * radius_of_stem(share);
        add_leaf(mesh,
                 {{x * inside, height * share, z * inside},
                  normalized({x, 0.3 + 0.6 * share + 0.2 * random(0), z}),
                  normalized({-z, 0.4 * random(2), x}),
                  (5 - 3.2 * share) * (1 + 0.2 * random(1)),
                  0.5 + 0.3 * random(3)},
                 columns, rows);
    }
    return mesh.take();
}

} // namespace tetrace
