// Cubes and lattices: grids of cubes, each cut into six tets. No mesh, no TetGen.
#include "core/base/control_groups.h"
#include "core/base/error.h"
#include "core/mesh/scene.h"
#include "scenes/catalogue.h"
#include "scenes/procedural.h"
#include "scenes/scramble.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

namespace {

/// Makes scenes of a jittered grid of resolution^3 cubes that fills its domain. Each cube is cut into six tets round
/// its main diagonal (Kuhn 1960; also Freudenthal's cut): one tet for each order in which a path from the low corner to
/// the high corner takes the three axes. The cut of all cubes is the same, so squares between them are cut along the
/// same diagonal on both sides, and every neighbour has a closed form. Time and memory are linear in the number of
/// tets.
class CubeGrid {
public:
    /// A cube, by its place along each axis.
    using Cell = std::array<std::int32_t, 3>;

    /// resolution: 2 to 563; half-faces of 30 bits name no more tets.
    explicit CubeGrid(std::uint32_t resolution) : n_(static_cast<std::int32_t>(resolution)) {}

    /// A scene whose occlusive faces are those between cubes that are solid and cubes that are not, wound outwards.
    /// is_solid: asked only of cubes of the grid. Reproducible bit for bit. The domain's divisions are the resolution
    /// up to 128; above that, each square has as many cubes along its sides as needed.
    [[nodiscard]] Scene make(const std::string& name, const std::function<bool(const Cell&)>& is_solid);

private:
    /// The place of line i of n even ones in units of 2^-20: 2^21 i / n - 2^20, rounded.
    [[nodiscard]] static std::int32_t place(std::int32_t i, std::int32_t n)
    {
        return ((1 << 21) * i + n / 2) / n - (1 << 20);
    }
    [[nodiscard]] std::int32_t line(std::int32_t i) const { return place(i, n_); }
    [[nodiscard]] bool in_grid(const Cell& cube) const
    {
        for (const std::int32_t i : cube)
            if (i < 0 || i >= n_) return false;
        return true;
    }
    [[nodiscard]] std::uint32_t vertex_index(const Cell& at) const
    {
        return static_cast<std::uint32_t>((at[2] * (n_ + 1) + at[1]) * (n_ + 1) + at[0]);
    }
    [[nodiscard]] std::uint32_t tet_index(const Cell& cube, std::uint32_t order) const
    {
        return 6 * static_cast<std::uint32_t>((cube[2] * n_ + cube[1]) * n_ + cube[0]) + order;
    }

    void make_lines();
    void make_vertices();
    void make_tets();
    [[nodiscard]] Tet make_tet(const Cell& cube, std::uint32_t order) const;
    [[nodiscard]] std::uint32_t outer_half_face(const Cell& cube, std::uint32_t axis, std::int32_t step,
                                                std::uint32_t order, std::uint32_t path_vertex) const;
    [[nodiscard]] Cell cube_of(std::uint32_t tet) const;
    void mark(const std::function<bool(const Cell&)>& is_solid);
    void add_triangle(std::uint32_t tet, std::uint32_t face, std::vector<std::uint32_t>& mesh_index);

    std::int32_t n_;
    Scene scene_;
};

constexpr std::int32_t max_divisions = 128; // as in scenes/scene_file.cpp: the entry grid grows with their square

/// Orders of the axes; even permutations first.
constexpr std::array<std::array<std::uint32_t, 3>, 6> orders = {
    {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

constexpr std::uint32_t order_of(std::uint32_t first, std::uint32_t second)
{
    for (std::uint32_t i = 0; i < orders.size(); ++i)
        if (orders[i][0] == first && orders[i][1] == second) return i;
    return 0;
}

/// Path vertices 0..3 of an even order make det > 0: there vertices 1 and 2 change places.
constexpr std::uint32_t local(std::uint32_t order, std::uint32_t step)
{
    return order < 3 && (step == 1 || step == 2) ? 3 - step : step;
}

/// Corners of each local face, counter-clockwise seen from outside a tet with det < 0.
constexpr std::array<std::array<std::uint32_t, 3>, 4> outward = {{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

Scene CubeGrid::make(const std::string& name, const std::function<bool(const Cell&)>& is_solid)
{
    make_lines();
    make_vertices();
    make_tets();
    mark(is_solid);
    scene_.name = name;
    scene_.build.source = fmt::format("{}, {} along each axis", name, n_);
    scene_.build.tool = "tetrace";
    return std::move(scene_);
}

void CubeGrid::make_lines()
{
    scene_.domain.kind = DomainKind::tight;
    const std::int32_t cubes = (n_ + max_divisions - 1) / max_divisions; // along a square's side
    const std::int32_t divisions = (n_ + cubes - 1) / cubes;
    scene_.domain.divisions = static_cast<std::uint32_t>(divisions);
    for (std::vector<float>& axis : scene_.domain.lines)
        for (std::int32_t i = 0; i <= divisions; ++i) // even, although cubes may then lie across them
            axis.push_back(static_cast<float>(place(i, divisions)) * 0x1p-20f);
}

// At most 0.15 of a cube's edge: below 1/6 each tet's matrix of path edges stays diagonally dominant, so none inverts.
void CubeGrid::make_vertices()
{
    const std::int32_t reach = (1 << 21) * 3 / (20 * n_);
    const auto lines = static_cast<std::size_t>(n_ + 1);
    scene_.tets.vertices.reserve(lines * lines * lines);
    Cell at;
    for (at[2] = 0; at[2] <= n_; ++at[2])
        for (at[1] = 0; at[1] <= n_; ++at[1])
            for (at[0] = 0; at[0] <= n_; ++at[0]) {
                bool inside = true;
                for (const std::int32_t i : at)
                    inside = inside && i > 0 && i < n_;
                Float3 point;
                for (std::uint32_t axis = 0; axis < 3; ++axis) {
                    const auto draw =
                        scramble(3 * vertex_index(at) + axis + 1) % static_cast<std::uint32_t>(2 * reach + 1);
                    const std::int32_t jitter = inside ? static_cast<std::int32_t>(draw) - reach : 0;
                    point[static_cast<int>(axis)] = static_cast<float>(line(at[axis]) + jitter) * 0x1p-20f;
                }
                scene_.tets.vertices.push_back(point);
            }
}

std::uint32_t CubeGrid::outer_half_face(const Cell& cube, std::uint32_t axis, std::int32_t step, std::uint32_t order,
                                        std::uint32_t path_vertex) const
{
    Cell next = cube;
    next[axis] += step;
    return in_grid(next) ? make_half_face(tet_index(next, order), local(order, path_vertex)) : NO_HALF_FACE;
}

// The face opposite path vertex 1 or 2 is shared with the path that swaps the two axes there, in the same cube. The
// face opposite vertex 0 is on the cube's high side along the first axis, where the next cube's path ends with that
// axis; the face opposite vertex 3 is on the low side along the last axis, where the cube before has it first.
Tet CubeGrid::make_tet(const Cell& cube, std::uint32_t order) const
{
    const auto [a, b, c] = orders[order];
    Tet tet{};
    tet.faces.fill(FREE_FACE);
    Cell corner = cube;
    for (std::uint32_t step = 0; step < 4; ++step) {
        tet.vertices[local(order, step)] = vertex_index(corner);
        if (step < 3) ++corner[orders[order][step]];
    }
    tet.neighbours[local(order, 0)] = outer_half_face(cube, a, 1, order_of(b, c), 3);
    tet.neighbours[local(order, 1)] = make_half_face(tet_index(cube, order_of(b, a)), local(order_of(b, a), 1));
    tet.neighbours[local(order, 2)] = make_half_face(tet_index(cube, order_of(a, c)), local(order_of(a, c), 2));
    tet.neighbours[local(order, 3)] = outer_half_face(cube, c, -1, order_of(c, a), 0);
    return tet;
}

void CubeGrid::make_tets()
{
    const auto n = static_cast<std::size_t>(n_);
    scene_.tets.tets.reserve(6 * n * n * n);
    Cell cube;
    for (cube[2] = 0; cube[2] < n_; ++cube[2])
        for (cube[1] = 0; cube[1] < n_; ++cube[1])
            for (cube[0] = 0; cube[0] < n_; ++cube[0])
                for (std::uint32_t order = 0; order < orders.size(); ++order)
                    scene_.tets.tets.push_back(make_tet(cube, order));
}

CubeGrid::Cell CubeGrid::cube_of(std::uint32_t tet) const
{
    const auto cube = static_cast<std::int32_t>(tet / 6);
    return {cube % n_, cube / n_ % n_, cube / (n_ * n_)};
}

void CubeGrid::mark(const std::function<bool(const Cell&)>& is_solid)
{
    std::vector<std::uint32_t> mesh_index(scene_.tets.vertices.size(), NO_HALF_FACE);
    for (std::uint32_t first = 0; first < scene_.tets.tets.size(); first += 6) {
        if (!is_solid(cube_of(first))) continue;
        for (std::uint32_t tet = first; tet < first + 6; ++tet)
            for (std::uint32_t face = 0; face < 4; ++face) {
                const std::uint32_t half_face = scene_.tets.tets[tet].neighbours[face];
                if (half_face != NO_HALF_FACE && !is_solid(cube_of(half_face_tet(half_face))))
                    add_triangle(tet, face, mesh_index);
            }
    }
}

void CubeGrid::add_triangle(std::uint32_t tet, std::uint32_t face, std::vector<std::uint32_t>& mesh_index)
{
    TriangleMesh& mesh = scene_.mesh;
    Tet& inner = scene_.tets.tets[tet];
    const auto id = static_cast<std::uint32_t>(mesh.triangles.size());
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = inner.vertices[outward[face][i]];
        if (mesh_index[vertex] == NO_HALF_FACE) {
            mesh_index[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(scene_.tets.vertices[vertex]);
        }
        triangle[i] = mesh_index[vertex];
    }
    mesh.triangles.push_back(triangle);
    const std::uint32_t half_face = inner.neighbours[face];
    inner.faces[face] = id;
    scene_.tets.tets[half_face_tet(half_face)].faces[half_face_index(half_face)] = id;
}

/// Centres within 0.6 of the box's half-size, in integers. Two cubes along an axis have none that near: there one cube
/// represents the ball, and its surface is open towards the domain's boundary.
bool in_ball(const CubeGrid::Cell& cube, std::int32_t n)
{
    if (n == 2) return cube == CubeGrid::Cell{0, 0, 0};
    std::int32_t distance = 0;
    for (const std::int32_t i : cube)
        distance += (2 * i + 1 - n) * (2 * i + 1 - n);
    return 25 * distance <= 9 * n * n;
}

/// Whether the cube is solid: 4 of 3 n are. A cube shows 1.5 times the area of its side to a line, on average over all
/// directions, so a line goes through n / 2 cubes before it meets a solid one. None is solid at the domain's sides.
bool is_solid(const CubeGrid::Cell& cube, std::int32_t n)
{
    for (const std::int32_t i : cube)
        if (i == 0 || i == n - 1) return false;
    if (cube == CubeGrid::Cell{n / 2, n / 2, n / 2}) return true; // so that no lattice is empty
    const auto number = static_cast<std::uint32_t>((cube[2] * n + cube[1]) * n + cube[0]);
    return scramble(~number) % static_cast<std::uint32_t>(3 * n) < 4;
}

/// Memory that the system hands out is not always there; a process that uses more is killed. Packing has all tets once
/// more, in its order.
void require_memory(std::uint64_t n)
{
    const std::uint64_t needed = 2 * lattice_tets(n) * sizeof(Tet) + (n + 1) * (n + 1) * (n + 1) * sizeof(Float3);
    if (const std::uint64_t there = available_memory_bytes(); needed > there)
        throw Error(ErrorKind::unsupported,
                    fmt::format("making scene lattice:{}: its {} tets take {} bytes until they are packed, and this "
                                "machine has {} left; use a smaller one",
                                n, lattice_tets(n), needed, there));
}

} // namespace

Scene make_cubes(std::uint32_t resolution)
{
    if (resolution < 2 || resolution > 128)
        throw Error(ErrorKind::usage,
                    fmt::format("making scene cubes: {} cubes along an axis; 2 to 128 are accepted", resolution));
    return CubeGrid(resolution).make("cubes", [n = static_cast<std::int32_t>(resolution)](const CubeGrid::Cell& cube) {
        return in_ball(cube, n);
    });
}

Scene make_lattice(std::uint32_t resolution)
{
    if (resolution < min_lattice || resolution > max_lattice)
        throw Error(ErrorKind::usage, fmt::format("making scene lattice: {} cubes along an axis; {} to {} are accepted",
                                                  resolution, min_lattice, max_lattice));
    require_memory(resolution);
    return CubeGrid(resolution)
        .make("lattice",
              [n = static_cast<std::int32_t>(resolution)](const CubeGrid::Cell& cube) { return is_solid(cube, n); });
}

} // namespace tetrace
