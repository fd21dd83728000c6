#pragma once

#include "scenes/optimise/collapse.h"
#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/insertion.h"
#include "scenes/optimise/shape.h"

#include <array>
#include <cstdint>
#include <functional>

namespace tetrace {

enum Operation : std::size_t { remove_edges, remove_faces, move_vertices, collapse_edges, insert_vertices };
inline constexpr std::size_t operation_count = 5;

/// What one kind of operation did in a region.
struct OperationTally {
    std::uint64_t done = 0;
    double gain = 0; ///< area of free faces
    double seconds = 0;
};

/// One round in one region: edges and faces twice, collapses, moves, insertions, each over all tets or vertices in
/// order.
class RegionPass {
public:
    struct Orders {
        std::uint32_t since;                     ///< only what was marked with it or later is looked at
        std::uint32_t mark;                      ///< for what changes (EditableMesh::round); more than `since`
        double least;                            ///< gain, an area
        double min_ring_area;                    ///< of Insertion, at the end; `impossible`: nothing is inserted
        std::function<bool(double share)> go_on; ///< asked now and then, with the share that is done
    };

    RegionPass(MeshArrays arrays, const Orders& orders);

    /// Returns what the operations have made of the mesh. Ends early, and sound, once `go_on` answers false.
    [[nodiscard]] MeshArrays run();

    [[nodiscard]] const std::array<OperationTally, operation_count>& tallies() const { return tallies_; }

private:
    template <class Try>
    void sweep(Operation operation, std::uint32_t count, const Try& try_one);
    void flip(std::uint32_t since);
    [[nodiscard]] bool inserts() const { return orders_.min_ring_area < impossible; }
    [[nodiscard]] bool is_new_tet(std::uint32_t tet) const;
    [[nodiscard]] bool is_new_face(std::uint32_t tet, std::uint32_t face) const;
    [[nodiscard]] bool is_new_vertex(std::uint32_t vertex) const;

    Orders orders_;
    EditableMesh mesh_;
    EdgeRemoval edges_;
    Collapse collapse_;
    Insertion insertion_;
    VertexStar star_;
    std::array<OperationTally, operation_count> tallies_;
    std::uint32_t sweeps_ = 0; ///< so far
    bool ended_ = false;
};

} // namespace tetrace
