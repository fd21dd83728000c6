#pragma once

#include "scenes/optimise/mesh_arrays.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tetrace {

/// The vertices of a tet, positive as core/mesh/tet_mesh.h has it.
using Corners = std::array<std::uint32_t, 4>;

/// A tet mesh whose parts are replaced by others. Everything that changes it keeps it a tetrahedralization of the same
/// domain with the same occlusive faces (docs/spec/rays-tets.md, O1). Memory: linear.
class EditableMesh {
public:
    /// mesh: sound (find_defect and find_gap find nothing).
    explicit EditableMesh(const TetMesh& mesh) : EditableMesh(arrays_of(mesh)) {}
    /// arrays: sound, with no unused tets.
    explicit EditableMesh(MeshArrays arrays);

    [[nodiscard]] std::uint32_t tet_slots() const { return static_cast<std::uint32_t>(arrays_.tets.size()); }
    [[nodiscard]] std::uint32_t vertex_slots() const { return static_cast<std::uint32_t>(arrays_.points.size()); }
    [[nodiscard]] const Tet& tet(std::uint32_t index) const { return arrays_.tets[index]; }
    [[nodiscard]] Double3 point(std::uint32_t vertex) const { return arrays_.points[vertex]; }

    /// Operations change no tets but these.
    [[nodiscard]] bool is_reached(std::uint32_t tet) const { return arrays_.states[tet] == TetState::reached; }
    /// Whether a vertex may move or vanish. It stays on the same sides of the domain's box.
    [[nodiscard]] bool is_free(std::uint32_t vertex) const { return arrays_.kinds[vertex] == VertexKind::free; }
    /// The sides of the domain's box that a vertex is on: none inside, two on an edge of the box, three at a corner.
    [[nodiscard]] BoxSides box_sides(std::uint32_t vertex) const { return arrays_.box_sides[vertex]; }
    /// A tet that has the vertex; NO_TET for a slot without a vertex.
    [[nodiscard]] std::uint32_t tet_of(std::uint32_t vertex) const { return tet_of_[vertex]; }

    /// The free_area() of its arrays: what the optimiser lowers.
    [[nodiscard]] double cost() const { return free_area(arrays_); }
    [[nodiscard]] double boundary_area() const { return tetrace::boundary_area(arrays_); }

    /// Puts `fresh` in the place of `old`, if that is sound: each fresh tet may be made (shape.h), and the fresh tets'
    /// outer faces are those of the old ones, side by side, but for boundary faces, which may become others of the same
    /// side (O1), no flatter than shape.h allows. Otherwise returns false and changes nothing.
    /// old: tets that rays reach, each once. Vertices that lose their last tet are dropped.
    bool replace(std::span<const std::uint32_t> old, std::span<const Corners> fresh);

    /// Moves a free vertex where each tet of `star`, all that have it, and each boundary face may still be made; else
    /// changes nothing. to: on the grid, as a float, and on the vertex's sides of the box.
    bool move(std::uint32_t vertex, std::span<const std::uint32_t> star, Double3 to);

    /// A free vertex without a tet, for the next replace(); drop it if that fails. sides: those that it is on.
    [[nodiscard]] std::uint32_t add_vertex(Double3 point, BoxSides sides);
    void drop_vertex(std::uint32_t vertex);

    /// The number that tets and vertices are marked with when they change. Starts with 1, and so do their marks.
    std::uint32_t round = 1;
    [[nodiscard]] std::uint32_t tet_changed(std::uint32_t tet) const { return arrays_.tet_changed[tet]; }
    [[nodiscard]] std::uint32_t vertex_changed(std::uint32_t vertex) const { return arrays_.vertex_changed[vertex]; }

    /// Marks on tets for a moment: unmark_all() is quick.
    void unmark_all() { ++mark_; }
    bool mark(std::uint32_t tet) ///< false if it was marked already
    {
        if (marks_[tet] == mark_) return false;
        marks_[tet] = mark_;
        return true;
    }
    [[nodiscard]] bool is_marked(std::uint32_t tet) const { return marks_[tet] == mark_; }

    /// The mesh without unused slots; vertices and tets keep their order.
    [[nodiscard]] TetMesh take() const { return mesh_of(arrays_); }
    /// All that it holds; then it is empty.
    [[nodiscard]] MeshArrays take_arrays() { return std::move(arrays_); }

private:
    /// One side of a face. Equal keys: the same face; equal turns: the same side of it.
    struct Side {
        std::array<std::uint32_t, 3> key; ///< vertices, ascending
        bool turn;                        ///< whether an odd permutation sorted them
        bool fresh;
        std::uint32_t half_face; ///< outer: what is across it; fresh: index in `fresh` << 2 | local face
        std::uint32_t triangle;
    };

    [[nodiscard]] bool may_be_on_boundary(const std::array<std::uint32_t, 3>& vertices) const;
    [[nodiscard]] bool may_stay(const Tet& tet) const;
    [[nodiscard]] static Side side_of(const Corners& corners, std::uint32_t face);
    [[nodiscard]] bool gather_sides(std::span<const std::uint32_t> old, std::span<const Corners> fresh);
    [[nodiscard]] bool sides_match() const;
    [[nodiscard]] bool is_pair(std::size_t i) const;
    void choose_slots(std::span<const std::uint32_t> old, std::size_t count);
    void connect();
    void connect_fresh(const Side& a, const Side& b);

    MeshArrays arrays_;
    std::vector<std::uint32_t> tet_of_, marks_;
    std::vector<std::uint32_t> unused_tets_, unused_vertices_;
    std::uint32_t mark_ = 0;
    std::vector<Side> sides_;                    ///< of the replacement at work
    std::vector<std::uint32_t> slots_, touched_; ///< where its fresh tets go; vertices of its old ones
};

} // namespace tetrace
