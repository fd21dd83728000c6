// Each cube of the grid is cut into six tets round its main diagonal (Kuhn 1960; also Freudenthal's cut): one tet for
// each order in which a path from the low corner to the high corner takes the three axes. The cut of all cubes is the
// same, so squares between them are cut along the same diagonal on both sides, and every neighbour has a closed form.
#include "core/base/error.h"
#include "scenes/procedural.h"

#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

namespace tetrace {

namespace {

using Cell = std::array<std::int32_t, 3>;

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

/// A number that depends on nothing but its counter (the finaliser of MurmurHash3).
constexpr std::uint32_t scramble(std::uint32_t counter)
{
    counter ^= counter >> 16;
    counter *= 0x85EBCA6Bu;
    counter ^= counter >> 13;
    counter *= 0xC2B2AE35u;
    return counter ^ counter >> 16;
}

class CubesMaker {
public:
    explicit CubesMaker(std::uint32_t resolution) : n_(static_cast<std::int32_t>(resolution)) {}

    [[nodiscard]] Scene make()
    {
        make_lines();
        make_vertices();
        make_tets();
        mark_ball();
        scene_.name = "cubes";
        scene_.build.source = fmt::format("cubes, {} along each axis", n_);
        scene_.build.tool = "tetrace";
        return std::move(scene_);
    }

private:
    /// Line i in units of 2^-20: 2^21 i / n - 2^20, rounded.
    [[nodiscard]] std::int32_t line(std::int32_t i) const { return ((1 << 21) * i + n_ / 2) / n_ - (1 << 20); }
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
    [[nodiscard]] std::uint32_t outer_link(const Cell& cube, std::uint32_t axis, std::int32_t step, std::uint32_t order,
                                           std::uint32_t path_vertex) const;
    [[nodiscard]] bool in_ball(const Cell& cube) const;
    [[nodiscard]] Cell cube_of(std::uint32_t tet) const;
    void mark_ball();
    void add_triangle(std::uint32_t tet, std::uint32_t face, std::vector<std::uint32_t>& mesh_index);

    std::int32_t n_;
    Scene scene_;
};

void CubesMaker::make_lines()
{
    scene_.domain.kind = DomainKind::tight;
    scene_.domain.divisions = static_cast<std::uint32_t>(n_);
    for (std::vector<float>& axis : scene_.domain.lines)
        for (std::int32_t i = 0; i <= n_; ++i)
            axis.push_back(static_cast<float>(line(i)) * 0x1p-20f);
}

// At most 0.15 of a cube's edge: below 1/6 each tet's matrix of path edges stays diagonally dominant, so none inverts.
void CubesMaker::make_vertices()
{
    const std::int32_t reach = (1 << 21) * 3 / (20 * n_);
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

std::uint32_t CubesMaker::outer_link(const Cell& cube, std::uint32_t axis, std::int32_t step, std::uint32_t order,
                                     std::uint32_t path_vertex) const
{
    Cell next = cube;
    next[axis] += step;
    return in_grid(next) ? make_link(tet_index(next, order), local(order, path_vertex)) : NO_LINK;
}

// The face opposite path vertex 1 or 2 is shared with the path that swaps the two axes there, in the same cube. The
// face opposite vertex 0 lies on the cube's high side along the first axis, where the next cube's path ends with that
// axis; the face opposite vertex 3 lies on the low side along the last axis, where the cube before has it first.
Tet CubesMaker::make_tet(const Cell& cube, std::uint32_t order) const
{
    const auto [a, b, c] = orders[order];
    Tet tet{};
    tet.faces.fill(FREE_FACE);
    Cell corner = cube;
    for (std::uint32_t step = 0; step < 4; ++step) {
        tet.vertices[local(order, step)] = vertex_index(corner);
        if (step < 3) ++corner[orders[order][step]];
    }
    tet.links[local(order, 0)] = outer_link(cube, a, 1, order_of(b, c), 3);
    tet.links[local(order, 1)] = make_link(tet_index(cube, order_of(b, a)), local(order_of(b, a), 1));
    tet.links[local(order, 2)] = make_link(tet_index(cube, order_of(a, c)), local(order_of(a, c), 2));
    tet.links[local(order, 3)] = outer_link(cube, c, -1, order_of(c, a), 0);
    return tet;
}

void CubesMaker::make_tets()
{
    Cell cube;
    for (cube[2] = 0; cube[2] < n_; ++cube[2])
        for (cube[1] = 0; cube[1] < n_; ++cube[1])
            for (cube[0] = 0; cube[0] < n_; ++cube[0])
                for (std::uint32_t order = 0; order < orders.size(); ++order)
                    scene_.tets.tets.push_back(make_tet(cube, order));
}

// Centres within 0.6 of the box's half-size, in integers. Two cubes along an axis have none that near: there one cube
// stands for the ball, and its surface is open towards the domain's boundary.
bool CubesMaker::in_ball(const Cell& cube) const
{
    if (n_ == 2) return cube == Cell{0, 0, 0};
    std::int32_t distance = 0;
    for (const std::int32_t i : cube)
        distance += (2 * i + 1 - n_) * (2 * i + 1 - n_);
    return 25 * distance <= 9 * n_ * n_;
}

Cell CubesMaker::cube_of(std::uint32_t tet) const
{
    const auto cube = static_cast<std::int32_t>(tet / 6);
    return {cube % n_, cube / n_ % n_, cube / (n_ * n_)};
}

void CubesMaker::mark_ball()
{
    std::vector<std::uint32_t> mesh_index(scene_.tets.vertices.size(), NO_LINK);
    for (std::uint32_t tet = 0; tet < scene_.tets.tets.size(); ++tet) {
        if (!in_ball(cube_of(tet))) continue;
        for (std::uint32_t face = 0; face < 4; ++face) {
            const std::uint32_t link = scene_.tets.tets[tet].links[face];
            if (link != NO_LINK && !in_ball(cube_of(link_tet(link)))) add_triangle(tet, face, mesh_index);
        }
    }
}

void CubesMaker::add_triangle(std::uint32_t tet, std::uint32_t face, std::vector<std::uint32_t>& mesh_index)
{
    TriangleMesh& mesh = scene_.mesh;
    Tet& inner = scene_.tets.tets[tet];
    const auto id = static_cast<std::uint32_t>(mesh.triangles.size());
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = inner.vertices[outward[face][i]];
        if (mesh_index[vertex] == NO_LINK) {
            mesh_index[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(scene_.tets.vertices[vertex]);
        }
        triangle[i] = mesh_index[vertex];
    }
    mesh.triangles.push_back(triangle);
    const std::uint32_t link = inner.links[face];
    inner.faces[face] = id;
    scene_.tets.tets[link_tet(link)].faces[link_face(link)] = id;
}

} // namespace

Scene make_cubes(std::uint32_t resolution)
{
    if (resolution < 2 || resolution > 128)
        throw Error(ErrorKind::usage,
                    fmt::format("making scene cubes: {} cubes along an axis; 2 to 128 are accepted", resolution));
    return CubesMaker(resolution).make();
}

} // namespace tetrace
