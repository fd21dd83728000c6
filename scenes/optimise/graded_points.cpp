#include "scenes/optimise/graded_points.h"

#include "core/base/exact.h"
#include "core/base/random_words.h"
#include "scenes/optimise/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tetrace {
namespace {

// Levels: 2^level cells along each axis.
constexpr std::uint32_t coarsest = 2, min_finest = 5, max_finest = 8;
constexpr double jitter = 0.1; // of a cell's size, to both sides: no two points may be cospherical
constexpr std::uint32_t jitter_stream = 0x67726164;

using Cell = std::array<std::uint32_t, 3>;

// Of equilateral triangles of the mesh's area.
double mean_edge(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += area(to_double(mesh.vertices[a]), to_double(mesh.vertices[b]), to_double(mesh.vertices[c]));
    return std::sqrt(4 / std::sqrt(3.0) * sum / static_cast<double>(mesh.triangles.size()));
}

double shortest(Double3 size)
{
    return std::min({size.x, size.y, size.z});
}

// The first level whose cells are, along their shortest side, no longer than the mesh's mean edge.
std::uint32_t finest_level(const TriangleMesh& mesh, Double3 size)
{
    const double edge = mean_edge(mesh);
    std::uint32_t level = min_finest;
    while (level < max_finest && shortest(size) > edge * (1U << level))
        ++level;
    return level;
}

class Octree {
public:
    Octree(const TriangleMesh& mesh, const Domain& domain)
        : low_(to_double(domain.low())), size_(to_double(domain.high()) - low_), finest_(finest_level(mesh, size_))
    {
        for (std::uint32_t level = coarsest; level <= finest_; ++level)
            held_[level].assign(std::size_t{1} << 3 * level, 0);
        for (const auto& [a, b, c] : mesh.triangles)
            add(to_double(mesh.vertices[a]), to_double(mesh.vertices[b]), to_double(mesh.vertices[c]));
        find_outside();
    }

    [[nodiscard]] std::vector<Float3> points() const
    {
        std::vector<Float3> found;
        for (std::uint32_t level = coarsest; level <= finest_; ++level) {
            const std::uint32_t n = 1U << level;
            for (std::uint32_t i = 0; i < n * n * n; ++i) {
                const Cell cell = {i % n, i / n % n, i / n / n};
                const Cell parent = {cell[0] / 2, cell[1] / 2, cell[2] / 2};
                const bool is_leaf = !holds(level, cell) && (level == coarsest || holds(level - 1, parent));
                if (is_leaf && is_outside(level, cell)) found.push_back(point_in(level, cell));
            }
        }
        return found;
    }

private:
    [[nodiscard]] static std::size_t index(std::uint32_t level, const Cell& cell)
    {
        return (((std::size_t{cell[2]} << level) + cell[1]) << level) + cell[0];
    }
    [[nodiscard]] bool holds(std::uint32_t level, const Cell& cell) const
    {
        return held_[level][index(level, cell)] != 0;
    }

    // From the cells on the domain's boundary through faces of empty cells, all of the finest level.
    void find_outside()
    {
        const std::uint32_t n = 1U << finest_;
        outside_.assign(held_[finest_].size(), 0);
        std::vector<Cell> front;
        const auto reach = [&](const Cell& cell) {
            if (holds(finest_, cell) || std::exchange(outside_[index(finest_, cell)], 1) != 0) return;
            front.push_back(cell);
        };
        for (std::uint32_t i = 0; i < n * n; ++i)
            for (const std::uint32_t end : {0U, n - 1}) {
                reach({end, i % n, i / n});
                reach({i % n, end, i / n});
                reach({i % n, i / n, end});
            }
        while (!front.empty()) {
            const Cell cell = front.back();
            front.pop_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const bool up : {false, true}) {
                    Cell next = cell;
                    next[axis] += up ? 1 : ~0U; // past the low end: far above n
                    if (next[axis] < n) reach(next);
                }
        }
    }
    // An empty cell's parts at the finest level are all outside, or none is.
    [[nodiscard]] bool is_outside(std::uint32_t level, Cell cell) const
    {
        for (std::uint32_t& coordinate : cell)
            coordinate <<= finest_ - level;
        return outside_[index(finest_, cell)] != 0;
    }

    void add_point(Double3 point)
    {
        const std::uint32_t n = 1U << finest_;
        const Double3 from_low = point - low_;
        const auto place = [n](double x, double size) {
            return static_cast<std::uint32_t>(std::clamp(x / size * n, 0.0, n - 1.0));
        };
        Cell cell = {place(from_low.x, size_.x), place(from_low.y, size_.y), place(from_low.z, size_.z)};
        for (std::uint32_t level = finest_; level >= coarsest; --level) {
            held_[level][index(level, cell)] = 1;
            for (std::uint32_t& coordinate : cell)
                coordinate /= 2;
        }
    }

    // Halves a triangle's longest edge until no edge is longer than a cell.
    void add(Double3 a, Double3 b, Double3 c)
    {
        const double ab = squared(b - a), bc = squared(c - b), ca = squared(a - c);
        if (bc > ab && bc >= ca) return add(b, c, a);
        if (ca > ab) return add(c, a, b);
        const double cell = shortest(size_) / (1U << finest_);
        if (ab > cell * cell) {
            const Double3 middle = (a + b) * 0.5;
            add(a, middle, c);
            add(middle, b, c);
            return;
        }
        for (const Double3 corner : {a, b, c})
            add_point(corner);
    }

    [[nodiscard]] Float3 point_in(std::uint32_t level, const Cell& cell) const
    {
        const RandomWords words = random_words({cell[0], cell[1], cell[2], level}, jitter_stream);
        const auto along = [&](std::size_t axis) {
            const double moved = jitter * (words[axis] * 0x1p-31 - 1);
            return (cell[axis] + 0.5 + moved) / (1U << level);
        };
        const Double3 at = {low_.x + size_.x * along(0), low_.y + size_.y * along(1), low_.z + size_.z * along(2)};
        return snap_to_grid(to_float(at));
    }

    Double3 low_, size_;
    std::uint32_t finest_;
    std::array<std::vector<std::uint8_t>, max_finest + 1> held_; ///< per level and cell: whether triangles are near it
    std::vector<std::uint8_t> outside_; ///< of the finest level: reached from the boundary through empty cells
};

} // namespace

std::vector<Float3> graded_points(const TriangleMesh& mesh, const Domain& domain)
{
    return Octree(mesh, domain).points();
}

} // namespace tetrace
