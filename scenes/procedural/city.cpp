// Blocks of houses along streets. A house is a grid of rooms: walls, floors and roofs are surfaces without thickness;
// outer walls have windows, inner ones doors. In the middle is a square with one detailed object, small in the city.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tetrace {

namespace {

constexpr std::uint32_t blocks = 7; ///< along each axis
constexpr double block = 3, street = 2;

class City {
public:
    explicit City(std::uint32_t rooms) : rooms_(rooms) // along a block's side
    {
        for (std::uint32_t i = 0; i < blocks; ++i) {
            const double start = i * (block + street);
            lines_.push_back(start);
            for (std::uint32_t room = 0; room < rooms_; ++room)
                lines_.push_back(start + street + block * room / rooms_);
        }
        lines_.push_back(blocks * (block + street));
        lines_.push_back(blocks * (block + street) + street);
        const auto cells = static_cast<std::uint32_t>(lines_.size() - 1);
        for (std::uint32_t z = 0; z < cells; ++z)
            for (std::uint32_t x = 0; x < cells; ++x)
                add_column(x, z);
    }

    MeshBuilder mesh;

private:
    /// Rooms above each other in a cell: 0 in streets and in the square.
    [[nodiscard]] std::uint32_t floors(std::uint32_t x, std::uint32_t z) const
    {
        const std::uint32_t period = rooms_ + 1, column = x / period, row = z / period;
        const bool is_street = x % period == 0 || z % period == 0;
        if (is_street || (column == blocks / 2 && row == blocks / 2)) return 0;
        return rooms_ * (1 + static_cast<std::uint32_t>(3 * random_unit(0, row * blocks + column)));
    }

    /// Ground, floors and roof of a cell, and its walls to the cells before it.
    void add_column(std::uint32_t x, std::uint32_t z)
    {
        const std::uint32_t top = floors(x, z);
        for (std::uint32_t level = 0; level <= top; ++level)
            mesh.quad({at(x, level, z), at(x, level, z + 1), at(x + 1, level, z + 1), at(x + 1, level, z)});
        const std::uint32_t top_x = x == 0 ? 0 : floors(x - 1, z), top_z = z == 0 ? 0 : floors(x, z - 1);
        for (std::uint32_t level = 0; level < std::max(top, top_x); ++level)
            add_wall({at(x, level, z), at(x, level, z + 1), at(x, level + 1, z + 1), at(x, level + 1, z)},
                     level < std::min(top, top_x));
        for (std::uint32_t level = 0; level < std::max(top, top_z); ++level)
            add_wall({at(x, level, z), at(x + 1, level, z), at(x + 1, level + 1, z), at(x, level + 1, z)},
                     level < std::min(top, top_z));
    }

    [[nodiscard]] Double3 at(std::uint32_t x, std::uint32_t level, std::uint32_t z) const
    {
        return {lines_[x], block * level / rooms_, lines_[z]};
    }

    /// Four corners, the lower two first. An inner wall is whole, or has a door.
    void add_wall(const std::array<Double3, 4>& corners, bool is_inner)
    {
        if (is_inner && random_unit(1, walls_++) < 0.3) {
            mesh.quad(corners);
            return;
        }
        const auto point = [&](double along, double up) {
            return mesh.vertex(corners[0] + (corners[1] - corners[0]) * along + (corners[3] - corners[0]) * up);
        };
        const double left = is_inner ? 0.35 : 0.2, low = is_inner ? 0.05 : 0.3, high = is_inner ? 0.75 : 0.85;
        const std::uint32_t outer[] = {point(0, 0), point(1, 0), point(1, 1), point(0, 1)};
        const std::uint32_t inner[] = {point(left, low), point(1 - left, low), point(1 - left, high),
                                       point(left, high)};
        mesh.strip(outer, inner, true);
    }

    std::uint32_t rooms_, walls_ = 0;
    std::vector<double> lines_; ///< of the grid of cells, the same along x and z
};

} // namespace

TriangleMesh make_city(std::uint32_t triangles)
{
    constexpr double triangles_of_rooms = 2'150; // times the cube of the rooms along a block's side, nearly
    std::uint32_t rooms = 1;
    while (triangles_of_rooms * (rooms + 1) * (rooms + 1) * (rooms + 1) <= 0.85 * triangles)
        ++rooms;
    City city(rooms);
    constexpr double middle = (blocks * (block + street) + street) / 2, radius = 0.3;
    city.mesh.sphere({middle, 1.5 * radius, middle}, radius,
                     sphere_edges(static_cast<double>(triangles) - static_cast<double>(city.mesh.triangles())),
                     [](Double3 direction) {
                         return 0.7 + 0.6 * fractal_noise(direction * 3 + Double3{9, 9, 9}, 7);
                     });
    return city.mesh.take();
}

} // namespace tetrace
