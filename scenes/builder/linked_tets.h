#pragma once

#include "core/mesh/tet_mesh.h"
#include "scenes/builder/cavity_fill.h"

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace tetrace {

/// What is on the other side of a cavity's face: NO_HALF_FACE or a half-face, and FREE_FACE or a triangle.
struct AcrossFace {
    std::uint32_t half_face, triangle;
};

/// The sides of a cavity, as the tets inside see them.
using CavitySides = std::map<FaceSide, AcrossFace>;

/// Tets of a mesh, some of which go and give their place to others. Those that have gone keep their numbers until
/// drop_gone().
class LinkedTets {
public:
    explicit LinkedTets(TetMesh& mesh);

    [[nodiscard]] bool is_gone(std::uint32_t tet) const { return is_gone_[tet]; }
    void remove(std::uint32_t tet) { is_gone_[tet] = true; }
    /// All tets that have the vertex.
    [[nodiscard]] std::vector<std::uint32_t> star(std::uint32_t vertex) const;
    /// Puts a vertex in another's place.
    void rename(std::uint32_t tet, std::uint32_t from, std::uint32_t to);
    /// Lets a half-face, if it is one, have another across it, on this triangle or free.
    void join(std::uint32_t half_face, std::uint32_t to, std::uint32_t triangle);

    /// The tets, and those beyond their free faces.
    [[nodiscard]] std::vector<std::uint32_t> grown(const std::vector<std::uint32_t>& tets) const;
    /// The sides of the tets' union; none if there is an occlusive face inside.
    [[nodiscard]] CavitySides sides_of(const std::vector<std::uint32_t>& tets) const;
    /// Puts tets of these corners in the place of others that have these sides, which they fill.
    void replace(const std::vector<std::uint32_t>& tets, CavitySides sides,
                 const std::vector<std::array<std::uint32_t, 4>>& by);

    /// Numbers the tets that are left.
    void drop_gone();

private:
    void note(std::uint32_t tet);
    void add(const std::array<std::uint32_t, 4>& corners, CavitySides& sides);

    TetMesh& mesh_;
    std::vector<std::uint32_t> tet_of_; ///< of each vertex, one that has it
    std::vector<bool> is_gone_;
};

} // namespace tetrace
