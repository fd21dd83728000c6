#pragma once

#include "core/mesh/tet_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace tetrace {

/// One side of a face: its corners as the tet on that side sees them, counter-clockwise, the least number first.
using FaceSide = std::array<std::uint32_t, 3>;

/// The inner side of the face across corner `face` of a positive tet.
[[nodiscard]] FaceSide face_side_of(const std::array<std::uint32_t, 4>& tet, std::size_t face);
/// The same face as the tet beyond it sees it.
[[nodiscard]] FaceSide reversed(const FaceSide& side);

/// A search for positive tets that fill a cavity: side after side of what is not yet filled, that with the fewest
/// possible tets first.
class CavityFill {
public:
    /// front: the cavity's sides, seen from inside. vertices: those that tets may have, the front's among them. tries:
    /// after these the search gives up. tests: how many it may make, for all cavities together; it subtracts its own.
    CavityFill(std::span<const Float3> points, std::set<FaceSide> front, std::set<std::uint32_t> vertices, int tries,
               std::uint64_t& tests)
        : points_(points), front_(std::move(front)), vertices_(std::move(vertices)), tries_(tries), tests_(tests)
    {
    }

    /// Finds tets that have all of these vertices; false if there are none, or too many to try.
    [[nodiscard]] bool find(const std::set<std::uint32_t>& needed);

    /// What find() found. Two tets that share a face see its two sides.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 4>>& tets() const { return tets_; }

private:
    void spend(std::size_t tests);
    [[nodiscard]] bool has_all(std::set<std::uint32_t> needed) const;
    [[nodiscard]] const std::vector<std::uint32_t>& vertices_above(const FaceSide& side);
    [[nodiscard]] std::vector<std::uint32_t> apexes_of(const FaceSide& side, std::size_t limit);
    [[nodiscard]] bool may_add(const FaceSide& side, std::uint32_t apex) const;
    void add(const FaceSide& side, std::uint32_t apex);

    std::span<const Float3> points_;
    std::set<FaceSide> front_, closed_;
    std::set<std::uint32_t> vertices_;
    std::map<FaceSide, std::vector<std::uint32_t>> above_;
    std::vector<std::array<std::uint32_t, 4>> tets_;
    int tries_;
    std::uint64_t& tests_;
};

} // namespace tetrace
