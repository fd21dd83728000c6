// A court open to the sky, with two storeys of arcades around it: fan vaults on columns, pierced walls, a stair,
// railings and a statue. Floors, vaults and walls are surfaces without thickness that share their edges.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

constexpr std::int32_t bays_x = 7, bays_z = 5; ///< squares with sides of 1; those not at the rim are the court
constexpr double storey = 1.3;
constexpr double gap = 1.0 / 128; ///< under free-standing objects

constexpr double capital_y = 0.74, capital_radius = 0.09, vault_rise = 0.46;
/// Radius and height at the rings of a column.
struct Ring {
    double radius, y;
};
constexpr Ring base[] = {{0.14, 0}, {0.14, 0.06}, {0.1, 0.08}, {0.075, 0.1}};
constexpr Ring shaft_end = {0.065, 0.7};

/// The vault's height above the floor, at a distance from the column's axis: a quarter of an ellipse.
double vault_y(double distance)
{
    constexpr double corner = 0.7071067811865476;
    const double share = std::clamp((distance - capital_radius) / (corner - capital_radius), 0.0, 1.0);
    return capital_y + vault_rise * std::sqrt(share * (2 - share));
}

class Atrium {
public:
    explicit Atrium(std::uint32_t cuts) : cuts_(cuts) // of a bay's side
    {
        for (std::int32_t z = 0; z < bays_z; ++z)
            for (std::int32_t x = 0; x < bays_x; ++x) {
                if (is_court(x, z)) {
                    add_court_floor(x, z);
                    continue;
                }
                for (const double floor : {0.0, storey})
                    add_bay(x, z, floor);
            }
        add_stair();
        add_railings();
    }

    MeshBuilder mesh;

private:
    using Row = std::vector<std::uint32_t>;

    static bool is_court(std::int32_t x, std::int32_t z) { return x > 0 && x < bays_x - 1 && z > 0 && z < bays_z - 1; }
    static bool is_outside(std::int32_t x, std::int32_t z) { return x < 0 || z < 0 || x >= bays_x || z >= bays_z; }

    /// Point i of the 4 cuts_ along the sides of a square around the origin, whose sides are 1 long.
    [[nodiscard]] Double3 rim(std::uint32_t i) const
    {
        const double along = static_cast<double>(i % cuts_) / cuts_ - 0.5;
        switch (i / cuts_ % 4) {
        case 0: return {along, 0, -0.5};
        case 1: return {0.5, 0, along};
        case 2: return {-along, 0, 0.5};
        default: return {-0.5, 0, -along};
        }
    }
    /// A ring around a column: `share` of the way from a circle to the square, at heights by the distance from the
    /// axis.
    template <class Height>
    [[nodiscard]] Row ring(Double3 foot, double radius, double share, Height height)
    {
        Row row;
        for (std::uint32_t i = 0; i < 4 * cuts_; ++i) {
            const Double3 out = rim(i);
            const Double3 at = normalized(out) * (radius * (1 - share)) + out * share;
            row.push_back(mesh.vertex(foot + at + Double3{0, height(length(at)), 0}));
        }
        return row;
    }

    /// From the square of the floor up the column and down to the square of the vault.
    void add_bay(std::int32_t x, std::int32_t z, double floor)
    {
        const Double3 foot = {x + 0.5, floor, z + 0.5};
        const std::uint32_t floor_rows = std::max(1u, cuts_ / 3), shaft_rows = std::max(1u, cuts_ * 2 / 3),
                            vault_rows = cuts_ + 2;
        const auto level = [](double y) { return [y](double) { return y; }; };
        std::vector<Row> rows;
        for (std::uint32_t i = floor_rows; i > 0; --i)
            rows.push_back(ring(foot, base[0].radius, static_cast<double>(i) / floor_rows, level(0)));
        for (const Ring& one : base)
            rows.push_back(ring(foot, one.radius, 0, level(one.y)));
        for (std::uint32_t i = 1; i <= shaft_rows; ++i) {
            const Ring& start = base[std::size(base) - 1];
            const double share = static_cast<double>(i) / shaft_rows;
            rows.push_back(ring(foot, start.radius + (shaft_end.radius - start.radius) * share, 0,
                                level(start.y + (shaft_end.y - start.y) * share)));
        }
        for (std::uint32_t i = 0; i <= vault_rows; ++i) {
            const double share = static_cast<double>(i) / vault_rows;
            rows.push_back(ring(foot, capital_radius, share * share, vault_y));
        }
        for (std::size_t i = 0; i + 1 < rows.size(); ++i)
            mesh.strip(rows[i], rows[i + 1], true);
        constexpr std::int32_t steps[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
        for (std::uint32_t side = 0; side < 4; ++side)
            if (const std::int32_t to_x = x + steps[side][0], to_z = z + steps[side][1]; is_outside(to_x, to_z))
                add_wall(foot, side, true);
            else if (is_court(to_x, to_z))
                add_wall(foot, side, false);
    }

    /// On one side of a bay: from the vault up to the next floor, and if it is a wall from the floor to the vault, with
    /// a window.
    void add_wall(Double3 foot, std::uint32_t side, bool from_floor)
    {
        const std::uint32_t wall_rows = std::max(4u, cuts_), pane = cuts_ / 3; // on either side of a window
        // `share` of the way from floor to vault, or from vault to next floor; from `first` to `last` of the side's
        // cuts.
        const auto row = [&](double share, bool above, std::uint32_t first, std::uint32_t last) {
            Row points;
            for (std::uint32_t i = side * cuts_ + first; i <= side * cuts_ + last; ++i) {
                const double top = vault_y(length(rim(i)));
                const double y = above ? top + (storey - top) * share : top * share;
                points.push_back(mesh.vertex(foot + rim(i) + Double3{0, y, 0}));
            }
            return points;
        };
        mesh.strip(row(0, true, 0, cuts_), row(1, true, 0, cuts_), false);
        for (std::uint32_t i = 0; from_floor && i < wall_rows; ++i) {
            const auto part = [&](std::uint32_t first, std::uint32_t last) {
                mesh.strip(row(static_cast<double>(i) / wall_rows, false, first, last),
                           row(static_cast<double>(i + 1) / wall_rows, false, first, last), false);
            };
            if (i < wall_rows / 4 || i >= wall_rows * 3 / 4) {
                part(0, cuts_);
            } else if (pane > 0) {
                part(0, pane);
                part(cuts_ - pane, cuts_);
            }
        }
    }

    void add_court_floor(std::int32_t x, std::int32_t z)
    {
        for (std::uint32_t i = 0; i < cuts_; ++i)
            for (std::uint32_t j = 0; j < cuts_; ++j) {
                const auto at = [&](std::uint32_t a, std::uint32_t b) {
                    return Double3{x + static_cast<double>(a) / cuts_, 0, z + static_cast<double>(b) / cuts_};
                };
                mesh.quad({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
            }
    }

    /// From the court's floor up to the upper storey: a closed slab of steps.
    void add_stair()
    {
        constexpr std::uint32_t steps = 20;
        constexpr double start = 3.4, end = bays_x - 1 - gap, near = 1.15, far = 1.65;
        const auto x = [&](std::uint32_t i) { return start + (end - start) * i / steps; };
        const auto y = [&](std::uint32_t i) { return gap + (storey - gap) * i / steps; };
        for (std::uint32_t i = 0; i < steps; ++i) {
            const double left = x(i), right = x(i + 1), low = y(i), high = y(i + 1);
            mesh.quad({{{left, low, near}, {left, low, far}, {left, high, far}, {left, high, near}}});
            mesh.quad({{{left, high, near}, {left, high, far}, {right, high, far}, {right, high, near}}});
            mesh.quad({{{left, low, far}, {left, low, near}, {right, high, near}, {right, high, far}}});
            for (const double side : {near, far})
                mesh.triangle(mesh.vertex({left, low, side}), mesh.vertex({left, high, side}),
                              mesh.vertex({right, high, side}));
        }
    }

    /// Around the upper storey's edge to the court: a rail on small pillars.
    void add_railings()
    {
        constexpr double inset = 0.06, half = 0.02, height = 0.28, foot = storey + gap;
        const auto along = [&](std::int32_t bays, auto point) {
            const std::uint32_t pillars = static_cast<std::uint32_t>(bays - 2) * cuts_;
            for (std::uint32_t i = 0; i < pillars; ++i)
                add_pillar(point(1 + (i + 0.5) / cuts_), foot, foot + height);
        };
        for (const double z : {1 - inset, bays_z - 1 + inset}) {
            along(bays_x, [&](double x) { return Double3{x, 0, z}; });
            mesh.box({1, foot + height + gap, z - half}, {bays_x - 1, foot + height + gap + half, z + half});
        }
        for (const double x : {1 - inset, bays_x - 1 + inset}) {
            along(bays_z, [&](double z) { return Double3{x, 0, z}; });
            mesh.box({x - half, foot + height + gap, 1}, {x + half, foot + height + gap + half, bays_z - 1});
        }
    }

    /// With six sides and a belly, closed.
    void add_pillar(Double3 at, double low, double high)
    {
        constexpr Double3 corners[] = {{1, 0, 0},  {0.5, 0, 0.866},   {-0.5, 0, 0.866},
                                       {-1, 0, 0}, {-0.5, 0, -0.866}, {0.5, 0, -0.866}};
        std::vector<Row> rows;
        for (const double share : {0.0, 0.2, 0.4, 0.7, 1.0}) {
            Row row;
            for (const Double3 corner : corners)
                row.push_back(mesh.vertex(at + corner * (0.008 + 0.05 * share * (1 - share)) +
                                          Double3{0, low + (high - low) * share, 0}));
            rows.push_back(row);
        }
        for (std::size_t i = 0; i + 1 < rows.size(); ++i)
            mesh.strip(rows[i], rows[i + 1], true);
        for (const Row& end : {rows.front(), rows.back()})
            for (std::size_t i = 1; i + 1 < end.size(); ++i)
                mesh.triangle(end[0], end[i], end[i + 1]);
    }

    std::uint32_t cuts_;
};

} // namespace

TriangleMesh make_atrium(std::uint32_t triangles)
{
    constexpr double triangles_of_a_cut = 1'350; // times the square of the cuts of a bay's side, nearly
    const double cuts = std::sqrt(0.85 * triangles / triangles_of_a_cut);
    Atrium atrium(std::max(2u, static_cast<std::uint32_t>(cuts)));
    const Double3 centre = {2.4, 0.55, 2.9};
    const double radius = 0.3;
    atrium.mesh.box({centre.x - 0.2, gap, centre.z - 0.2},
                    {centre.x + 0.2, centre.y - radius * 1.15 - gap, centre.z + 0.2});
    atrium.mesh.sphere(centre, radius,
                       sphere_edges(static_cast<double>(triangles) - static_cast<double>(atrium.mesh.triangles())),
                       [](Double3 direction) {
                           return 0.85 + 0.3 * fractal_noise(direction * 2 + Double3{7, 7, 7}, 6);
                       });
    return atrium.mesh.take();
}

} // namespace tetrace
