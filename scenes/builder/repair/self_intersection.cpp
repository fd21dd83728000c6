#include "scenes/builder/repair/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// The cases by shared vertices are those of Loriot, Rouxel-Labbe, Tournois, Yaz, "Polygon Mesh Processing", CGAL
// manual, self-intersections.

namespace tetrace {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triple = std::array<std::uint32_t, 3>;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

std::vector<Point> to_points(const TriangleMesh& mesh)
{
    std::vector<Point> points;
    points.reserve(mesh.vertices.size());
    for (const Float3 vertex : mesh.vertices) {
        const Double3 v = to_double(vertex);
        points.emplace_back(v.x, v.y, v.z);
    }
    return points;
}

// Turned so that the corners that `other` has come first.
Triple shared_first(const Triple& triangle, const Triple& other, int& shared)
{
    Triple turned{};
    std::size_t placed = 0;
    for (const bool wanted : {true, false}) {
        for (const std::uint32_t corner : triangle)
            if ((std::ranges::find(other, corner) != other.end()) == wanted) turned[placed++] = corner;
        if (wanted) shared = static_cast<int>(placed);
    }
    return turned;
}

class PairTest {
public:
    explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh), points_(to_points(mesh)) {}

    [[nodiscard]] bool meet_elsewhere(std::uint32_t first, std::uint32_t second) const
    {
        int shared = 0;
        const Triple a = shared_first(mesh_.triangles[first], mesh_.triangles[second], shared);
        const Triple b = shared_first(mesh_.triangles[second], mesh_.triangles[first], shared);
        if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
        // What two triangles share in addition to a common corner ends on the edge opposite it, of one or the other.
        if (shared == 1)
            return CGAL::do_intersect(edge(a[1], a[2]), triangle(b)) ||
                   CGAL::do_intersect(edge(b[1], b[2]), triangle(a));
        return folded(points_[a[0]], points_[a[1]], points_[a[2]], points_[b[2]]);
    }
    [[nodiscard]] Box box(std::uint32_t number) const { return {triangle(mesh_.triangles[number]).bbox(), number}; }

private:
    [[nodiscard]] Kernel::Triangle_3 triangle(const Triple& t) const
    {
        return {points_[t[0]], points_[t[1]], points_[t[2]]};
    }
    [[nodiscard]] Kernel::Segment_3 edge(std::uint32_t a, std::uint32_t b) const { return {points_[a], points_[b]}; }
    // Two triangles over the edge pq: folded onto each other in one plane.
    static bool folded(const Point& p, const Point& q, const Point& r, const Point& s)
    {
        return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
    }

    const TriangleMesh& mesh_;
    std::vector<Point> points_;
};

// In the coordinates of the mesh's file.
std::string corners_text(const Scene& scene, std::uint32_t triangle)
{
    const double unit = std::ldexp(1.0, -scene.build.scale_exponent);
    const int digits = scene.build.centre == Double3{} ? 9 : 15;
    std::string text;
    for (const std::uint32_t vertex : scene.mesh.triangles[triangle]) {
        const Double3 v = to_double(scene.mesh.vertices[vertex]) * unit + scene.build.centre;
        text += fmt::format(" ({:.{}g}, {:.{}g}, {:.{}g})", v.x, digits, v.y, digits, v.z, digits);
    }
    return text;
}

// Calls what(pair) for each that has a new triangle, in no order.
template <class What>
void for_each_pair(const TriangleMesh& mesh, const std::vector<bool>& is_new, const What& what)
{
    const PairTest test(mesh);
    std::vector<Box> changed, kept;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        (is_new[i] ? changed : kept).push_back(test.box(i));
    const auto try_pair = [&](const Box& a, const Box& b) {
        const auto [low, high] = std::minmax({a.info(), b.info()});
        if (test.meet_elsewhere(low, high)) what(TrianglePair{low, high});
    };
    CGAL::box_self_intersection_d(changed.begin(), changed.end(), try_pair);
    CGAL::box_intersection_d(changed.begin(), changed.end(), kept.begin(), kept.end(), try_pair);
}

std::vector<bool> all_of(const TriangleMesh& mesh)
{
    return std::vector<bool>(mesh.triangles.size(), true);
}

} // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh, std::size_t listed)
{
    SelfIntersections found;
    for_each_pair(mesh, all_of(mesh), [&](const TrianglePair& pair) {
        ++found.count;
        found.first.insert(std::upper_bound(found.first.begin(), found.first.end(), pair), pair);
        if (found.first.size() > listed) found.first.pop_back();
    });
    return found;
}

std::vector<TrianglePair> intersecting_pairs(const TriangleMesh& mesh)
{
    return intersecting_pairs(mesh, all_of(mesh));
}

std::vector<TrianglePair> intersecting_pairs(const TriangleMesh& mesh, const std::vector<bool>& is_new)
{
    std::vector<TrianglePair> pairs;
    for_each_pair(mesh, is_new, [&](const TrianglePair& pair) { pairs.push_back(pair); });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::string describe(const SelfIntersections& found, const Scene& scene)
{
    std::string text =
        fmt::format("{} pairs of triangles intersect elsewhere than in a shared vertex or edge", found.count);
    for (const auto& pair : found.first)
        for (const std::uint32_t triangle : {pair.first, pair.second})
            text += fmt::format("\n  triangle {}{}", source_triangle(scene, triangle), corners_text(scene, triangle));
    if (found.first.size() < found.count) text += "\n  ...";
    return text + "\na repair (without --no-repair) cuts them; or remove these in another program (MeshLab: "
                  "Filters, Cleaning and Repairing; CGAL: autorefine) and try again";
}

} // namespace tetrace
