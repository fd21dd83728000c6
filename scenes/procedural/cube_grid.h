// procedural/: generators of meshes and scenes, one file each. Cubes and lattices are grids of cubes, each cut into six
// tets: no mesh, no TetGen.
#pragma once

#include "core/mesh/scene.h"
#include "scenes/scramble.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tetrace {

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

} // namespace tetrace
