#pragma once

#include "scenes/optimise/mesh_arrays.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// A face of a region with a tet across it that is not in the region. Sides are half-faces of the whole mesh.
struct Wall {
    std::uint32_t own, beyond; ///< the face's two sides
    std::uint32_t triangle;    ///< the triangle that it is a part of, or FREE_FACE
};

/// Some tets of a mesh, as a mesh of its own. Its walls are occlusive faces that name triangle `first_wall` + number of
/// the wall: no operation changes them, or moves a vertex of theirs.
struct Region {
    MeshArrays mesh;
    std::vector<std::uint32_t> vertices; ///< per vertex, that of the whole mesh
    std::vector<Wall> walls;

    static constexpr std::uint32_t first_wall = 0x80000000;
};

/// The tets of a mesh that rays reach, in parts of about equal size (docs/spec/rays-tets.md, "In parallel"): they are
/// halved by planes across the axis along which their centroids reach farthest, until a part has no more than
/// `max_tets`. They depend only on the mesh and `pass`, and differ from one pass to the next. Work: n log n.
class Regions {
public:
    Regions(const MeshArrays& whole, std::uint32_t pass, std::size_t max_tets);

    [[nodiscard]] std::size_t size() const { return ends_.size(); }

    /// For cut(): one a thread.
    struct Scratch {
        std::vector<std::uint32_t> place; ///< per vertex of the whole mesh
    };

    /// A region with copies of its tets and vertices. What walls keep from being looked at, though it was marked with
    /// `since` or later, is marked with `later`.
    [[nodiscard]] Region cut(std::size_t index, std::uint32_t since, std::uint32_t later, Scratch& scratch) const;

    /// Puts all regions back, in order, whatever operations have made of them. The tets' numbers change; vertices keep
    /// theirs, and new ones follow.
    static void join(MeshArrays& whole, std::vector<Region> regions);

private:
    void halve(std::size_t begin, std::size_t end, std::uint32_t depth);
    [[nodiscard]] std::uint32_t local_half_face(std::size_t index, std::uint32_t half_face) const;

    const MeshArrays& whole_;
    std::uint32_t pass_;
    std::size_t max_tets_;
    std::vector<std::uint32_t> tets_;     ///< of all regions, one after the other; ascending in each
    std::vector<std::size_t> ends_;       ///< per region, in tets_
    std::vector<std::uint32_t> position_; ///< per tet of the whole mesh, in tets_; NO_TET for the hidden
};

} // namespace tetrace
