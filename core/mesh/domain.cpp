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

} // namespace tetrace
