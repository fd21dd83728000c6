#include "core/mesh/domain.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace tetrace {
namespace {

constexpr double line_grid = 0x1p-20;
constexpr double tight_margin = 0.01; // of the largest extent, on each side: 2 % in all
constexpr double wide_half_size = 3;  // bounding-sphere radii

std::vector<float> make_lines(double low, double high, std::uint32_t divisions, int axis)
{
    const double first = std::floor(low / line_grid);
    const double last = std::ceil(high / line_grid);
    std::vector<float> lines(divisions + 1);
    for (std::uint32_t i = 0; i <= divisions; ++i)
        lines[i] = static_cast<float>(std::nearbyint(first + (last - first) * i / divisions) * line_grid);
    if (std::ranges::adjacent_find(lines, std::greater_equal<>()) != lines.end())
        throw Error(ErrorKind::invalid_input,
                    "making the domain: the mesh is too small for its distance from the origin along axis " +
                        std::string(1, "xyz"[axis]) + " (float32 cannot resolve it); move it to the origin");
    return lines;
}

// Vertices of a domain's surface, shared between squares and sides.
class SurfaceBuilder {
public:
    explicit SurfaceBuilder(const Domain& domain) : domain_(domain) {}

    std::uint32_t vertex(const std::array<std::uint32_t, 3>& line)
    {
        const auto [at, is_new] = index_.try_emplace(line, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new)
            mesh_.vertices.push_back({domain_.lines[0][line[0]], domain_.lines[1][line[1]], domain_.lines[2][line[2]]});
        return at->second;
    }

    void add_square(std::size_t axis, bool high, std::uint32_t i, std::uint32_t j)
    {
        std::array<std::uint32_t, 4> corner{};
        constexpr std::uint32_t steps[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (std::size_t k = 0; k < 4; ++k) {
            std::array<std::uint32_t, 3> line{};
            line[axis] = high ? domain_.divisions : 0;
            line[(axis + 1) % 3] = i + steps[k][0];
            line[(axis + 2) % 3] = j + steps[k][1];
            corner[k] = vertex(line);
        }
        if (!high) std::swap(corner[1], corner[3]); // wound outwards
        mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
        mesh_.triangles.push_back({corner[0], corner[2], corner[3]});
    }

    TriangleMesh take() { return std::move(mesh_); }

private:
    const Domain& domain_;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> index_;
    TriangleMesh mesh_;
};

// Range of intervals of `lines` that [low, high] overlaps with more than a point.
std::pair<std::uint32_t, std::uint32_t> overlapped(const std::vector<float>& lines, float low, float high)
{
    const auto first = std::ranges::upper_bound(lines, low) - lines.begin() - 1;
    const auto last = std::ranges::lower_bound(lines, high) - lines.begin();
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
}

struct BoundaryFace {
    std::uint32_t link = 0;
    std::array<Float3, 3> corners;
};

std::vector<BoundaryFace> boundary_faces(const TetMesh& mesh)
{
    std::vector<BoundaryFace> faces;
    for (std::uint32_t index = 0; index < mesh.tets.size(); ++index) {
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (mesh.tets[index].links[face] != NO_LINK) continue;
            BoundaryFace found{make_link(index, face), {}};
            for (std::uint32_t i = 0, n = 0; i < 4; ++i)
                if (i != face) found.corners[n++] = mesh.vertices[mesh.tets[index].vertices[i]];
            faces.push_back(found);
        }
    }
    return faces;
}

// The side of the box that holds all three corners; 6 where there is none.
std::uint32_t side_of(const Domain& domain, const BoundaryFace& face)
{
    for (const Float3 corner : face.corners)
        if (!domain.contains(corner)) return 6;
    for (std::uint32_t side = 0; side < 6; ++side) {
        const auto axis = side / 2;
        const float plane = side % 2 == 0 ? domain.lines[axis].front() : domain.lines[axis].back();
        const auto on_plane = [&](Float3 p) { return p[static_cast<int>(axis)] == plane; };
        if (std::ranges::all_of(face.corners, on_plane)) return side;
    }
    return 6;
}

template <class Visit>
void for_each_square(const Domain& domain, const BoundaryFace& face, std::uint32_t side, const Visit& visit)
{
    const std::uint32_t n = domain.divisions;
    std::pair<std::uint32_t, std::uint32_t> range[2];
    for (std::uint32_t k = 0; k < 2; ++k) {
        const auto axis = static_cast<int>((side / 2 + 1 + k) % 3);
        const auto [low, high] = std::minmax({face.corners[0][axis], face.corners[1][axis], face.corners[2][axis]});
        range[k] = overlapped(domain.lines[static_cast<std::size_t>(axis)], low, high);
    }
    for (std::uint32_t j = range[1].first; j < range[1].second; ++j)
        for (std::uint32_t i = range[0].first; i < range[0].second; ++i)
            visit((side * n + j) * n + i);
}

} // namespace

bool Domain::contains(Float3 p) const
{
    for (int axis = 0; axis < 3; ++axis) {
        const auto& line = lines[static_cast<std::size_t>(axis)];
        if (!(p[axis] >= line.front() && p[axis] <= line.back())) return false;
    }
    return true;
}

Domain make_domain(const TriangleMesh& mesh, DomainKind kind, std::uint32_t divisions)
{
    const BoundingSphere sphere = bounding_sphere(mesh);
    Domain domain{kind, divisions, {}};
    double low[3], high[3], extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = high[axis] = static_cast<double>(mesh.vertices.front()[axis]);
        for (const Float3 v : mesh.vertices) {
            low[axis] = std::min(low[axis], static_cast<double>(v[axis]));
            high[axis] = std::max(high[axis], static_cast<double>(v[axis]));
        }
        extent = std::max(extent, high[axis] - low[axis]);
    }
    const double centre[3] = {sphere.centre.x, sphere.centre.y, sphere.centre.z};
    for (int axis = 0; axis < 3; ++axis) {
        const double margin = tight_margin * extent;
        const double half = wide_half_size * sphere.radius;
        const bool tight = kind == DomainKind::tight;
        domain.lines[static_cast<std::size_t>(axis)] =
            make_lines(tight ? low[axis] - margin : centre[axis] - half,
                       tight ? high[axis] + margin : centre[axis] + half, divisions, axis);
    }
    return domain;
}

TriangleMesh domain_surface(const Domain& domain)
{
    SurfaceBuilder builder(domain);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true})
            for (std::uint32_t j = 0; j < domain.divisions; ++j)
                for (std::uint32_t i = 0; i < domain.divisions; ++i)
                    builder.add_square(axis, high, i, j);
    return builder.take();
}

EntryGrid make_entry_grid(const Domain& domain, const TetMesh& mesh)
{
    const auto faces = boundary_faces(mesh);
    std::vector<std::uint32_t> sides;
    EntryGrid grid;
    grid.ranges.assign(std::size_t{6} * domain.divisions * domain.divisions + 1, 0);
    for (const BoundaryFace& face : faces) {
        sides.push_back(side_of(domain, face));
        if (sides.back() == 6)
            throw Error(ErrorKind::invalid_input, "making the entry grid: tet " + std::to_string(link_tet(face.link)) +
                                                      " has a boundary face that lies on no side of the domain");
        for_each_square(domain, face, sides.back(), [&](std::uint32_t square) { grid.ranges[square + 1]++; });
    }
    const auto empty = std::find(grid.ranges.begin() + 1, grid.ranges.end(), 0U);
    if (empty != grid.ranges.end())
        throw Error(ErrorKind::invalid_input, "making the entry grid: square " +
                                                  std::to_string(empty - grid.ranges.begin() - 1) +
                                                  " of the domain has no boundary face");
    for (std::size_t i = 1; i < grid.ranges.size(); ++i)
        grid.ranges[i] += grid.ranges[i - 1];
    grid.links.resize(grid.ranges.back());
    auto next = grid.ranges;
    for (std::size_t i = 0; i < faces.size(); ++i)
        for_each_square(domain, faces[i], sides[i],
                        [&](std::uint32_t square) { grid.links[next[square]++] = faces[i].link; });
    return grid;
}

} // namespace tetrace
