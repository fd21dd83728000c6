#include "scenes/builder/polygon.h"

#include <cmath>
#include <cstdlib>

// Source: Meisters, "Polygons have ears", 1975.

namespace tetrace {
namespace {

// A polygon in the plane on which it is largest, counterclockwise there.
class FlatPolygon {
public:
    explicit FlatPolygon(std::span<const Float3> corners)
    {
        Double3 normal{0, 0, 0}; // Newell's, of length twice the area
        const Double3 first = to_double(corners[0]);
        for (std::size_t i = 2; i < corners.size(); ++i)
            normal = normal + cross(to_double(corners[i - 1]) - first, to_double(corners[i]) - first);
        const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
        for (const Float3 corner : corners) {
            const Double3 v = to_double(corner);
            if (x >= y && x >= z)
                points_.push_back({normal.x < 0 ? -v.y : v.y, v.z});
            else if (y >= z)
                points_.push_back({normal.y < 0 ? -v.z : v.z, v.x});
            else
                points_.push_back({normal.z < 0 ? -v.x : v.x, v.y});
        }
    }

    // Twice the area of a triangle of corners; negative where it is turned the other way.
    [[nodiscard]] double area(std::size_t a, std::size_t b, std::size_t c) const
    {
        const Point &p = points_[a], &q = points_[b], &r = points_[c];
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }
    [[nodiscard]] bool holds(std::size_t a, std::size_t b, std::size_t c, std::size_t other) const
    {
        return area(a, b, other) >= 0 && area(b, c, other) >= 0 && area(c, a, other) >= 0;
    }
    [[nodiscard]] bool same_place(std::size_t a, std::size_t b) const { return points_[a] == points_[b]; }

private:
    using Point = std::array<double, 2>;

    std::vector<Point> points_;
};

std::vector<std::array<std::size_t, 3>> fan(std::size_t corners)
{
    std::vector<std::array<std::size_t, 3>> triangles;
    for (std::size_t i = 2; i < corners; ++i)
        triangles.push_back({0, i - 1, i});
    return triangles;
}

// Triangles of one orientation around a corner, in less than a full rotation, do not overlap.
bool is_fan_sound(const FlatPolygon& polygon, std::size_t corners)
{
    for (std::size_t i = 2; i < corners; ++i)
        if (polygon.area(0, i - 1, i) < 0) return false;
    return true;
}

class EarCutter {
public:
    EarCutter(const FlatPolygon& polygon, std::size_t corners) : polygon_(polygon)
    {
        for (std::size_t i = 0; i < corners; ++i)
            left_.push_back(i);
    }

    std::vector<std::array<std::size_t, 3>> cut()
    {
        std::size_t at = 0, misses = 0;
        while (left_.size() > 3) {
            at %= left_.size();
            // Where no corner is an ear, as rounding and crossings may have it, any is taken.
            if (misses++ < left_.size() && !is_ear(at)) {
                ++at;
                continue;
            }
            triangles_.push_back(ear(at));
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
            misses = 0;
        }
        triangles_.push_back({left_[0], left_[1], left_[2]});
        return std::move(triangles_);
    }

private:
    [[nodiscard]] std::array<std::size_t, 3> ear(std::size_t at) const
    {
        const std::size_t count = left_.size();
        return {left_[(at + count - 1) % count], left_[at], left_[(at + 1) % count]};
    }
    [[nodiscard]] bool is_ear(std::size_t at) const
    {
        const auto [a, b, c] = ear(at);
        if (!(polygon_.area(a, b, c) > 0)) return false;
        for (const std::size_t other : left_) {
            const bool is_corner =
                polygon_.same_place(other, a) || polygon_.same_place(other, b) || polygon_.same_place(other, c);
            if (!is_corner && polygon_.holds(a, b, c, other)) return false;
        }
        return true;
    }

    const FlatPolygon& polygon_;
    std::vector<std::size_t> left_;
    std::vector<std::array<std::size_t, 3>> triangles_;
};

} // namespace

std::vector<std::array<std::size_t, 3>> cut_polygon(std::span<const Float3> corners)
{
    if (corners.size() < 4 || corners.size() > max_concave_corners) return fan(corners.size());
    const FlatPolygon polygon(corners);
    if (is_fan_sound(polygon, corners.size())) return fan(corners.size());
    return EarCutter(polygon, corners.size()).cut();
}

} // namespace tetrace
