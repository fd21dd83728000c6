#include "core/mesh/entry_grid.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/mesh/tet_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

namespace tetrace {

namespace {

/// A point of a side's plane.
struct Point {
    double x, y;
};
using Corners = std::array<Point, 3>;

struct Rectangle {
    Point low, high;
};

struct BoundaryFace {
    std::uint32_t half_face, side;
    Corners corners; ///< along the two other axes of the side, in cyclic order
};

/// The side of the box that has all three corners; 6 where there is none.
std::uint32_t side_of(const Domain& domain, const std::array<Float3, 3>& corners)
{
    for (const Float3 corner : corners)
        if (!domain.contains(corner)) return 6;
    for (std::uint32_t side = 0; side < 6; ++side) {
        const auto axis = side / 2;
        const float plane = side % 2 == 0 ? domain.lines[axis].front() : domain.lines[axis].back();
        const auto on_plane = [&](Float3 p) { return p[static_cast<int>(axis)] == plane; };
        if (std::ranges::all_of(corners, on_plane)) return side;
    }
    return 6;
}

BoundaryFace boundary_face(const Domain& domain, const TetMesh& mesh, std::uint32_t half_face)
{
    std::array<Float3, 3> at;
    for (std::size_t i = 0; i < 3; ++i)
        at[i] =
            mesh.vertices[mesh.tets[half_face_tet(half_face)].vertices[face_corners[half_face_index(half_face)][i]]];
    BoundaryFace face{half_face, side_of(domain, at), {}};
    if (face.side == 6)
        throw Error(ErrorKind::invalid_input, "making the entry grid: tet " + std::to_string(half_face_tet(half_face)) +
                                                  " has a boundary face that is on no side of the domain");
    const auto axis = static_cast<int>(face.side / 2);
    for (std::size_t i = 0; i < 3; ++i)
        face.corners[i] = {at[i][(axis + 1) % 3], at[i][(axis + 2) % 3]};
    return face;
}

std::vector<BoundaryFace> boundary_faces(const Domain& domain, const TetMesh& mesh)
{
    std::vector<BoundaryFace> faces;
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face)
            if (mesh.tets[tet].neighbours[face] == NO_HALF_FACE)
                faces.push_back(boundary_face(domain, mesh, make_half_face(tet, face)));
    return faces;
}

/// Whether a line along an edge of the triangle parts it from the rectangle. It errs by roundings only, which are far
/// below entry_margin.
bool is_parted(const Corners& corners, const Rectangle& box)
{
    for (std::size_t i = 0; i < 3; ++i) {
        const Point a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
        Point normal{b.y - a.y, a.x - b.x};
        const double inwards = normal.x * (c.x - a.x) + normal.y * (c.y - a.y);
        if (inwards < 0) normal = {-normal.x, -normal.y};
        const Point innermost{normal.x > 0 ? box.high.x : box.low.x, normal.y > 0 ? box.high.y : box.low.y};
        if (normal.x * (innermost.x - a.x) + normal.y * (innermost.y - a.y) < 0) return true;
    }
    return false;
}

/// What is left of a polygon on the inner side of a line along an axis (Sutherland, Hodgman 1974).
template <class Depth>
std::vector<Point> clipped(const std::vector<Point>& polygon, const Depth& depth)
{
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double at_p = depth(p), at_q = depth(q);
        if (at_p >= 0) kept.push_back(p);
        if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
            const double part = at_p / (at_p - at_q);
            kept.push_back({p.x + (q.x - p.x) * part, p.y + (q.y - p.y) * part});
        }
    }
    return kept;
}

/// The share of a square that a face covers, in sixteenths.
std::uint32_t share_of(const Corners& corners, const Rectangle& square)
{
    std::vector<Point> polygon(corners.begin(), corners.end());
    polygon = clipped(polygon, [&](Point p) { return p.x - square.low.x; });
    polygon = clipped(polygon, [&](Point p) { return square.high.x - p.x; });
    polygon = clipped(polygon, [&](Point p) { return p.y - square.low.y; });
    polygon = clipped(polygon, [&](Point p) { return square.high.y - p.y; });
    double area = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Point a = polygon[0], b = polygon[i - 1], c = polygon[i];
        area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    const double whole = (square.high.x - square.low.x) * (square.high.y - square.low.y);
    return static_cast<std::uint32_t>(std::lround(16 * std::abs(area) / whole));
}

/// The intervals of `lines` that come within entry_margin of [low, high]: first to last - 1.
std::pair<std::uint32_t, std::uint32_t> intervals_near(const std::vector<float>& lines, double low, double high)
{
    const auto last_line = lines.size() - 1;
    const auto first = std::ranges::lower_bound(lines, low - entry_margin) - lines.begin();
    const auto last = std::ranges::upper_bound(lines, high + entry_margin) - lines.begin();
    return {static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(first, 1) - 1),
            static_cast<std::uint32_t>(std::min<std::size_t>(static_cast<std::size_t>(last), last_line))};
}

struct Listed {
    std::uint32_t square, share, half_face;
};

/// Calls visit(Listed) for each square that a face touches or nearly touches.
template <class Visit>
void for_each_square(const Domain& domain, const BoundaryFace& face, const Visit& visit)
{
    const std::uint32_t n = domain.divisions;
    const auto& [a, b, c] = face.corners;
    const auto& across = domain.lines[(face.side / 2 + 1) % 3];
    const auto& upwards = domain.lines[(face.side / 2 + 2) % 3];
    const auto [first_i, last_i] = intervals_near(across, std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}));
    const auto [first_j, last_j] = intervals_near(upwards, std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}));
    for (std::uint32_t j = first_j; j < last_j; ++j)
        for (std::uint32_t i = first_i; i < last_i; ++i) {
            const Rectangle square{{across[i], upwards[j]}, {across[i + 1], upwards[j + 1]}};
            const Rectangle near{{square.low.x - entry_margin, square.low.y - entry_margin},
                                 {square.high.x + entry_margin, square.high.y + entry_margin}};
            if (is_parted(face.corners, near)) continue;
            visit(Listed{(face.side * n + j) * n + i, share_of(face.corners, square), face.half_face});
        }
}

} // namespace

EntryGrid make_entry_grid(const Domain& domain, const TetMesh& mesh)
{
    const std::uint32_t squares = 6 * domain.divisions * domain.divisions;
    std::vector<Listed> listed;
    for (const BoundaryFace& face : boundary_faces(domain, mesh)) {
        for_each_square(domain, face, [&](const Listed& entry) { listed.push_back(entry); });
        listed.push_back({squares + face.side, 0, face.half_face});
    }
    std::ranges::sort(listed, [](const Listed& a, const Listed& b) {
        return a.square != b.square ? a.square < b.square
               : a.share != b.share ? a.share > b.share
                                    : a.half_face < b.half_face;
    });
    EntryGrid grid;
    grid.ranges.assign(std::size_t{squares} + 7, 0);
    for (const Listed& entry : listed) {
        grid.ranges[entry.square + 1]++;
        grid.half_faces.push_back(entry.half_face);
    }
    const auto empty = std::find(grid.ranges.begin() + 1, grid.ranges.end(), 0U);
    if (empty != grid.ranges.end())
        throw Error(ErrorKind::invalid_input, "making the entry grid: square " +
                                                  std::to_string(empty - grid.ranges.begin() - 1) +
                                                  " of the domain touches no boundary face");
    for (std::size_t i = 1; i < grid.ranges.size(); ++i)
        grid.ranges[i] += grid.ranges[i - 1];
    return grid;
}

namespace {

constexpr double camera_radii = 3; // core/rays/camera_set.h: the farthest is 2.9 away; core/rays/camera.h: own ones 3
constexpr double bounds_needed = 3;

double min_distance(const Scene& scene)
{
    const BoundingSphere sphere = bounding_sphere(scene.mesh);
    const double in_domain = std::sqrt(3.0);
    const double farthest = std::max(in_domain, length(sphere.centre) + camera_radii * sphere.radius);
    return bounds_needed * tie_bound({static_cast<float>(farthest), 0, 0});
}

std::string side_name(int axis, bool is_high)
{
    return std::string(is_high ? "high " : "low ") + "xyz"[axis] + " side";
}

/// The least of a triangle's three heights.
double height_of(const std::array<Double3, 3>& corners)
{
    const Double3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
    return length(cross(ab, ac)) / std::max({length(ab), length(ac), length(bc)});
}

double height_of(const TetMesh& mesh, std::uint32_t half_face)
{
    std::array<Double3, 3> corners;
    for (std::uint32_t i = 0, n = 0; i < 4; ++i)
        if (i != half_face_index(half_face))
            corners[n++] = to_double(mesh.vertices[mesh.tets[half_face_tet(half_face)].vertices[i]]);
    return height_of(corners);
}

std::string domain_too_large(const Domain& domain)
{
    for (int axis = 0; axis < 3; ++axis)
        if (domain.low()[axis] < -1 || domain.high()[axis] > 1)
            return std::string("the domain exceeds [-1, 1] along axis ") + "xyz"[axis] +
                   "; scale mesh and domain by a power of two";
    return "";
}

std::string mesh_too_near(const Scene& scene, double needed)
{
    for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool is_high : {false, true}) {
                const auto at = static_cast<double>(scene.mesh.vertices[i][axis]);
                const double distance = is_high ? static_cast<double>(scene.domain.high()[axis]) - at
                                                : at - static_cast<double>(scene.domain.low()[axis]);
                if (distance >= needed) continue;
                std::ostringstream text;
                text << "vertex " << i << " of the mesh is " << distance << " away from the domain's "
                     << side_name(axis, is_high) << ", rounding asks for " << needed << "; use a larger domain";
                return text.str();
            }
    return "";
}

std::string face_too_thin(const Scene& scene, const EntryGrid& grid, double needed)
{
    for (std::uint32_t side = 0; side < 6; ++side)
        for (const std::uint32_t half_face : faces_of_side(grid, side)) {
            const double height = height_of(scene.tets, half_face);
            if (height >= needed) continue;
            std::ostringstream text;
            text << "a boundary face of tet " << half_face_tet(half_face) << ", on the domain's "
                 << side_name(static_cast<int>(side / 2), side % 2 == 1) << ", has a height of " << height
                 << ", rounding asks for " << needed << "; use fewer divisions, or tets without such a face";
            return text.str();
        }
    return "";
}

} // namespace

std::string find_weak_side(const Scene& scene, const EntryGrid& grid)
{
    std::string found = domain_too_large(scene.domain);
    const double needed = min_distance(scene);
    if (found.empty()) found = mesh_too_near(scene, needed);
    if (found.empty()) found = face_too_thin(scene, grid, needed);
    return found;
}

} // namespace tetrace
