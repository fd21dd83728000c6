#include "scenes/optimise/editable_mesh.h"

#include "core/mesh/tet_mesh.h"
#include "scenes/optimise/shape.h"

#include <algorithm>
#include <utility>

namespace tetrace {

EditableMesh::EditableMesh(MeshArrays arrays)
    : arrays_(std::move(arrays)), tet_of_(arrays_.points.size(), NO_TET), marks_(arrays_.tets.size(), 0)
{
    for (std::uint32_t t = 0; t < arrays_.tets.size(); ++t)
        for (const std::uint32_t v : arrays_.tets[t].vertices)
            tet_of_[v] = t;
}

bool EditableMesh::may_be_on_boundary(const std::array<std::uint32_t, 3>& vertices) const
{
    return may_be_boundary_face(arrays_.points[vertices[0]], arrays_.points[vertices[1]], arrays_.points[vertices[2]]);
}

EditableMesh::Side EditableMesh::side_of(const Corners& corners, std::uint32_t face)
{
    const auto& [i, j, k] = face_corners[face];
    Side side{{corners[i], corners[j], corners[k]}, false, false, NO_HALF_FACE, FREE_FACE};
    const auto order = [&](std::size_t a, std::size_t b) {
        if (side.key[a] < side.key[b]) return;
        std::swap(side.key[a], side.key[b]);
        side.turn = !side.turn;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return side;
}

// The outer sides of the old tets, and all sides of the fresh ones, sorted. False if a tet cannot be replaced or
// made.
bool EditableMesh::gather_sides(std::span<const std::uint32_t> old, std::span<const Corners> fresh)
{
    sides_.clear();
    unmark_all();
    for (const std::uint32_t t : old)
        if (arrays_.states[t] != TetState::reached || !mark(t)) return false;
    for (const std::uint32_t t : old)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const Tet& tet = arrays_.tets[t];
            const bool inner = tet.neighbours[face] != NO_HALF_FACE && tet.faces[face] == FREE_FACE &&
                               is_marked(half_face_tet(tet.neighbours[face]));
            if (inner) continue;
            Side side = side_of(tet.vertices, face);
            side.half_face = tet.neighbours[face];
            side.triangle = tet.faces[face];
            sides_.push_back(side);
        }
    for (std::uint32_t i = 0; i < fresh.size(); ++i) {
        const auto& [a, b, c, d] = fresh[i];
        if (!may_be_made(arrays_.points[a], arrays_.points[b], arrays_.points[c], arrays_.points[d])) return false;
        for (std::uint32_t face = 0; face < 4; ++face) {
            Side side = side_of(fresh[i], face);
            side.fresh = true;
            side.half_face = make_half_face(i, face);
            sides_.push_back(side);
        }
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
        return a.key != b.key ? a.key < b.key : a.fresh != b.fresh ? b.fresh : a.half_face < b.half_face;
    });
    return true;
}

// Whether side i and the next one are of one face.
bool EditableMesh::is_pair(std::size_t i) const
{
    return i + 1 < sides_.size() && sides_[i].key == sides_[i + 1].key;
}

// Sides come in twos: an outer one with a fresh one that turns alike, or two fresh ones that turn against each other.
// Sides that remain unpaired are on the box: boundary faces that vanish, or appear. They do not change a side of the
// box.
bool EditableMesh::sides_match() const
{
    BoxSides touched = 0;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        const Side& a = sides_[i];
        if (i > 0 && sides_[i - 1].key == a.key) return false; // a third one
        if (is_pair(i)) {
            const Side& b = sides_[++i];
            if (!b.fresh || (a.turn == b.turn) == a.fresh) return false;
            continue;
        }
        const BoxSides common = common_sides(arrays_, a.key);
        if (common == 0) return false;
        if (a.fresh ? !may_be_on_boundary(a.key) : a.half_face != NO_HALF_FACE || a.triangle != FREE_FACE) return false;
        touched |= common;
    }
    return touched != all_box_sides;
}

void EditableMesh::choose_slots(std::span<const std::uint32_t> old, std::size_t count)
{
    slots_.assign(old.begin(), old.begin() + static_cast<std::ptrdiff_t>(std::min(old.size(), count)));
    for (const std::uint32_t t : old.subspan(slots_.size())) {
        arrays_.states[t] = TetState::unused;
        unused_tets_.push_back(t);
    }
    while (slots_.size() < count) {
        if (unused_tets_.empty()) {
            unused_tets_.push_back(tet_slots());
            arrays_.tets.emplace_back();
            arrays_.states.push_back(TetState::unused);
            arrays_.tet_changed.push_back(round);
            marks_.push_back(0);
        }
        slots_.push_back(unused_tets_.back());
        unused_tets_.pop_back();
    }
}

void EditableMesh::connect_fresh(const Side& a, const Side& b)
{
    arrays_.tets[slots_[half_face_tet(a.half_face)]].neighbours[half_face_index(a.half_face)] =
        make_half_face(slots_[half_face_tet(b.half_face)], half_face_index(b.half_face));
}

void EditableMesh::connect()
{
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        if (!is_pair(i)) continue;
        const Side &a = sides_[i], &b = sides_[i + 1];
        ++i;
        if (a.fresh) {
            connect_fresh(a, b);
            connect_fresh(b, a);
            continue;
        }
        const std::uint32_t slot = slots_[half_face_tet(b.half_face)];
        arrays_.tets[slot].neighbours[half_face_index(b.half_face)] = a.half_face;
        arrays_.tets[slot].faces[half_face_index(b.half_face)] = a.triangle;
        if (a.half_face != NO_HALF_FACE)
            arrays_.tets[half_face_tet(a.half_face)].neighbours[half_face_index(a.half_face)] =
                make_half_face(slot, half_face_index(b.half_face));
    }
}

bool EditableMesh::replace(std::span<const std::uint32_t> old, std::span<const Corners> fresh)
{
    if (!gather_sides(old, fresh) || !sides_match()) return false;
    std::vector<std::uint32_t>& touched = touched_;
    touched.clear();
    for (const std::uint32_t t : old)
        for (const std::uint32_t v : arrays_.tets[t].vertices) {
            tet_of_[v] = NO_TET;
            touched.push_back(v);
        }
    choose_slots(old, fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        const std::uint32_t slot = slots_[i];
        arrays_.tets[slot].vertices = fresh[i];
        arrays_.tets[slot].faces.fill(FREE_FACE);
        arrays_.tets[slot].neighbours.fill(NO_HALF_FACE);
        arrays_.states[slot] = TetState::reached;
        arrays_.tet_changed[slot] = round;
        for (const std::uint32_t v : fresh[i]) {
            tet_of_[v] = slot;
            arrays_.vertex_changed[v] = round;
        }
    }
    connect();
    for (const std::uint32_t v : touched)
        if (tet_of_[v] == NO_TET && arrays_.kinds[v] == VertexKind::free) drop_vertex(v);
    return true;
}

bool EditableMesh::may_stay(const Tet& tet) const
{
    const auto& v = tet.vertices;
    if (!may_be_made(arrays_.points[v[0]], arrays_.points[v[1]], arrays_.points[v[2]], arrays_.points[v[3]]))
        return false;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto& [a, b, c] = face_corners[face];
        if (tet.neighbours[face] == NO_HALF_FACE && tet.faces[face] == FREE_FACE &&
            !may_be_on_boundary({v[a], v[b], v[c]}))
            return false;
    }
    return true;
}

bool EditableMesh::move(std::uint32_t vertex, std::span<const std::uint32_t> star, Double3 to)
{
    const Double3 from = arrays_.points[vertex];
    const BoxSides sides = arrays_.box_sides[vertex];
    if ((holds_axis(sides, 0) && to.x != from.x) || (holds_axis(sides, 1) && to.y != from.y) ||
        (holds_axis(sides, 2) && to.z != from.z))
        return false;
    arrays_.points[vertex] = to;
    if (!std::all_of(star.begin(), star.end(), [&](std::uint32_t t) { return may_stay(arrays_.tets[t]); })) {
        arrays_.points[vertex] = from;
        return false;
    }
    for (const std::uint32_t t : star) {
        arrays_.tet_changed[t] = round;
        for (const std::uint32_t v : arrays_.tets[t].vertices)
            arrays_.vertex_changed[v] = round;
    }
    return true;
}

std::uint32_t EditableMesh::add_vertex(Double3 point, BoxSides sides)
{
    if (unused_vertices_.empty()) {
        unused_vertices_.push_back(vertex_slots());
        arrays_.points.push_back(point);
        arrays_.kinds.push_back(VertexKind::held);
        arrays_.box_sides.push_back(0);
        tet_of_.push_back(NO_TET);
        arrays_.vertex_changed.push_back(round);
    }
    const std::uint32_t vertex = unused_vertices_.back();
    unused_vertices_.pop_back();
    arrays_.points[vertex] = point;
    arrays_.kinds[vertex] = VertexKind::free;
    arrays_.box_sides[vertex] = sides;
    return vertex;
}

void EditableMesh::drop_vertex(std::uint32_t vertex)
{
    arrays_.kinds[vertex] = VertexKind::held; // so that it is dropped once
    unused_vertices_.push_back(vertex);
}

} // namespace tetrace
