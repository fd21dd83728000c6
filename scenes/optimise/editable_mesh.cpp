#include "scenes/optimise/editable_mesh.h"

#include "core/mesh/face_corners.h"
#include "scenes/optimise/shape.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace tetrace {

EditableMesh::EditableMesh(const TetMesh& mesh)
    : tets_(mesh.tets), states_(mesh.tets.size(), State::hidden), kinds_(mesh.vertices.size(), VertexKind::held),
      box_sides_(mesh.vertices.size(), 0), tet_of_(mesh.vertices.size(), NO_TET), tet_changed_(mesh.tets.size(), 1),
      vertex_changed_(mesh.vertices.size(), 1), marks_(mesh.tets.size(), 0)
{
    points_.reserve(mesh.vertices.size());
    for (const Float3 vertex : mesh.vertices)
        points_.push_back(to_double(vertex));
    find_reached();
    find_box_sides();
    find_kinds();
}

void EditableMesh::find_reached()
{
    std::vector<std::uint32_t> front;
    const auto reach = [&](std::uint32_t tet) {
        if (std::exchange(states_[tet], State::reached) == State::hidden) front.push_back(tet);
    };
    for (std::uint32_t t = 0; t < tets_.size(); ++t)
        for (std::size_t face = 0; face < 4; ++face)
            if (tets_[t].links[face] == NO_LINK && tets_[t].faces[face] == FREE_FACE) reach(t);
    while (!front.empty()) {
        const Tet& tet = tets_[front.back()];
        front.pop_back();
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.faces[face] == FREE_FACE && tet.links[face] != NO_LINK) reach(link_tet(tet.links[face]));
    }
}

void EditableMesh::find_box_sides()
{
    std::vector<std::uint32_t> on_boundary;
    Double3 low{impossible, impossible, impossible}, high = low * -1.0;
    for (const Tet& tet : tets_)
        for (std::uint32_t face = 0; face < 4; ++face)
            for (const std::uint32_t corner : face_corners[face]) {
                if (tet.links[face] != NO_LINK) continue;
                on_boundary.push_back(tet.vertices[corner]);
                const Double3 at = points_[on_boundary.back()];
                low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
                high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
            }
    for (const std::uint32_t v : on_boundary) {
        const Double3 at = points_[v];
        box_sides_[v] = (at.x == low.x ? 1u : 0u) | (at.x == high.x ? 2u : 0u) | (at.y == low.y ? 4u : 0u) |
                        (at.y == high.y ? 8u : 0u) | (at.z == low.z ? 16u : 0u) | (at.z == high.z ? 32u : 0u);
    }
}

BoxSides EditableMesh::common_sides(const std::array<std::uint32_t, 3>& vertices) const
{
    return box_sides_[vertices[0]] & box_sides_[vertices[1]] & box_sides_[vertices[2]];
}

bool EditableMesh::may_be_on_boundary(const std::array<std::uint32_t, 3>& vertices) const
{
    return may_be_boundary_face(points_[vertices[0]], points_[vertices[1]], points_[vertices[2]]);
}

// A vertex is held by occlusive faces, by boundary faces that lie on no side of a box, and at the box's corners.
void EditableMesh::find_kinds()
{
    for (std::uint32_t t = 0; t < tets_.size(); ++t)
        for (const std::uint32_t v : tets_[t].vertices) {
            tet_of_[v] = t;
            if (states_[t] == State::reached) kinds_[v] = VertexKind::free;
        }
    for (const Tet& tet : tets_)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const auto& [a, b, c] = face_corners[face];
            const std::array<std::uint32_t, 3> v = {tet.vertices[a], tet.vertices[b], tet.vertices[c]};
            if (tet.faces[face] == FREE_FACE && (tet.links[face] != NO_LINK || common_sides(v) != 0)) continue;
            for (const std::uint32_t vertex : v)
                kinds_[vertex] = VertexKind::held;
        }
    for (std::size_t v = 0; v < points_.size(); ++v)
        if (std::popcount(box_sides_[v]) > 2) kinds_[v] = VertexKind::held;
}

double EditableMesh::cost() const
{
    double sum = 0;
    for (std::uint32_t t = 0; t < tets_.size(); ++t) {
        if (states_[t] != State::reached) continue;
        const Tet& tet = tets_[t];
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (tet.faces[face] != FREE_FACE || tet.links[face] == NO_LINK || link_tet(tet.links[face]) < t) continue;
            const auto& [a, b, c] = face_corners[face];
            sum += area(points_[tet.vertices[a]], points_[tet.vertices[b]], points_[tet.vertices[c]]);
        }
    }
    return sum;
}

double EditableMesh::boundary_area() const
{
    double sum = 0;
    for (std::uint32_t t = 0; t < tets_.size(); ++t)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const auto& [a, b, c] = face_corners[face];
            const Corners& v = tets_[t].vertices;
            if (states_[t] != State::unused && tets_[t].links[face] == NO_LINK)
                sum += area(points_[v[a]], points_[v[b]], points_[v[c]]);
        }
    return sum;
}

EditableMesh::Side EditableMesh::side_of(const Corners& corners, std::uint32_t face)
{
    const auto& [i, j, k] = face_corners[face];
    Side side{{corners[i], corners[j], corners[k]}, false, false, NO_LINK, FREE_FACE};
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

// The outer sides of the old tets, and all sides of the fresh ones, sorted. False where a tet cannot be replaced or
// made.
bool EditableMesh::gather_sides(std::span<const std::uint32_t> old, std::span<const Corners> fresh)
{
    sides_.clear();
    unmark_all();
    for (const std::uint32_t t : old)
        if (states_[t] != State::reached || !mark(t)) return false;
    for (const std::uint32_t t : old)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const Tet& tet = tets_[t];
            const bool inner =
                tet.links[face] != NO_LINK && tet.faces[face] == FREE_FACE && is_marked(link_tet(tet.links[face]));
            if (inner) continue;
            Side side = side_of(tet.vertices, face);
            side.link = tet.links[face];
            side.triangle = tet.faces[face];
            sides_.push_back(side);
        }
    for (std::uint32_t i = 0; i < fresh.size(); ++i) {
        const auto& [a, b, c, d] = fresh[i];
        if (!may_be_made(points_[a], points_[b], points_[c], points_[d])) return false;
        for (std::uint32_t face = 0; face < 4; ++face) {
            Side side = side_of(fresh[i], face);
            side.fresh = true;
            side.link = make_link(i, face);
            sides_.push_back(side);
        }
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
        return a.key != b.key ? a.key < b.key : a.fresh != b.fresh ? b.fresh : a.link < b.link;
    });
    return true;
}

// Whether side i and the next one are of one face.
bool EditableMesh::is_pair(std::size_t i) const
{
    return i + 1 < sides_.size() && sides_[i].key == sides_[i + 1].key;
}

// Sides come in twos: an outer one with a fresh one that turns alike, or two fresh ones that turn against each other.
// Sides that stay alone lie on the box: boundary faces that go, or come. They leave a side of the box alone.
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
        const BoxSides common = common_sides(a.key);
        if (common == 0) return false;
        if (a.fresh ? !may_be_on_boundary(a.key) : a.link != NO_LINK || a.triangle != FREE_FACE) return false;
        touched |= common;
    }
    return touched != all_box_sides;
}

void EditableMesh::choose_slots(std::span<const std::uint32_t> old, std::size_t count)
{
    slots_.assign(old.begin(), old.begin() + static_cast<std::ptrdiff_t>(std::min(old.size(), count)));
    for (const std::uint32_t t : old.subspan(slots_.size())) {
        states_[t] = State::unused;
        unused_tets_.push_back(t);
    }
    while (slots_.size() < count) {
        if (unused_tets_.empty()) {
            unused_tets_.push_back(tet_slots());
            tets_.emplace_back();
            states_.push_back(State::unused);
            tet_changed_.push_back(round);
            marks_.push_back(0);
        }
        slots_.push_back(unused_tets_.back());
        unused_tets_.pop_back();
    }
}

void EditableMesh::connect_fresh(const Side& a, const Side& b)
{
    tets_[slots_[link_tet(a.link)]].links[link_face(a.link)] = make_link(slots_[link_tet(b.link)], link_face(b.link));
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
        const std::uint32_t slot = slots_[link_tet(b.link)];
        tets_[slot].links[link_face(b.link)] = a.link;
        tets_[slot].faces[link_face(b.link)] = a.triangle;
        if (a.link != NO_LINK) tets_[link_tet(a.link)].links[link_face(a.link)] = make_link(slot, link_face(b.link));
    }
}

bool EditableMesh::replace(std::span<const std::uint32_t> old, std::span<const Corners> fresh)
{
    if (!gather_sides(old, fresh) || !sides_match()) return false;
    std::vector<std::uint32_t>& touched = touched_;
    touched.clear();
    for (const std::uint32_t t : old)
        for (const std::uint32_t v : tets_[t].vertices) {
            tet_of_[v] = NO_TET;
            touched.push_back(v);
        }
    choose_slots(old, fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        const std::uint32_t slot = slots_[i];
        tets_[slot].vertices = fresh[i];
        tets_[slot].faces.fill(FREE_FACE);
        tets_[slot].links.fill(NO_LINK);
        states_[slot] = State::reached;
        tet_changed_[slot] = round;
        for (const std::uint32_t v : fresh[i]) {
            tet_of_[v] = slot;
            vertex_changed_[v] = round;
        }
    }
    connect();
    for (const std::uint32_t v : touched)
        if (tet_of_[v] == NO_TET && kinds_[v] == VertexKind::free) drop_vertex(v);
    return true;
}

bool EditableMesh::may_stay(const Tet& tet) const
{
    const auto& v = tet.vertices;
    if (!may_be_made(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]])) return false;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto& [a, b, c] = face_corners[face];
        if (tet.links[face] == NO_LINK && !may_be_on_boundary({v[a], v[b], v[c]})) return false;
    }
    return true;
}

bool EditableMesh::move(std::uint32_t vertex, std::span<const std::uint32_t> star, Double3 to)
{
    const Double3 from = points_[vertex];
    const BoxSides sides = box_sides_[vertex];
    if ((holds_axis(sides, 0) && to.x != from.x) || (holds_axis(sides, 1) && to.y != from.y) ||
        (holds_axis(sides, 2) && to.z != from.z))
        return false;
    points_[vertex] = to;
    if (!std::all_of(star.begin(), star.end(), [&](std::uint32_t t) { return may_stay(tets_[t]); })) {
        points_[vertex] = from;
        return false;
    }
    for (const std::uint32_t t : star) {
        tet_changed_[t] = round;
        for (const std::uint32_t v : tets_[t].vertices)
            vertex_changed_[v] = round;
    }
    return true;
}

std::uint32_t EditableMesh::add_vertex(Double3 point, BoxSides sides)
{
    if (unused_vertices_.empty()) {
        unused_vertices_.push_back(vertex_slots());
        points_.push_back(point);
        kinds_.push_back(VertexKind::held);
        box_sides_.push_back(0);
        tet_of_.push_back(NO_TET);
        vertex_changed_.push_back(round);
    }
    const std::uint32_t vertex = unused_vertices_.back();
    unused_vertices_.pop_back();
    points_[vertex] = point;
    kinds_[vertex] = VertexKind::free;
    box_sides_[vertex] = sides;
    return vertex;
}

void EditableMesh::drop_vertex(std::uint32_t vertex)
{
    kinds_[vertex] = VertexKind::held; // so that it is dropped once
    unused_vertices_.push_back(vertex);
}

TetMesh EditableMesh::take() const
{
    TetMesh mesh;
    std::vector<std::uint32_t> vertex_place(points_.size(), 0), tet_place(tets_.size(), 0);
    for (std::size_t v = 0; v < points_.size(); ++v) {
        if (tet_of_[v] == NO_TET) continue;
        vertex_place[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(to_float(points_[v]));
    }
    for (std::size_t t = 0; t < tets_.size(); ++t) {
        if (states_[t] == State::unused) continue;
        tet_place[t] = static_cast<std::uint32_t>(mesh.tets.size());
        mesh.tets.push_back(tets_[t]);
    }
    for (Tet& tet : mesh.tets)
        for (std::size_t i = 0; i < 4; ++i) {
            tet.vertices[i] = vertex_place[tet.vertices[i]];
            if (tet.links[i] != NO_LINK)
                tet.links[i] = make_link(tet_place[link_tet(tet.links[i])], link_face(tet.links[i]));
        }
    return mesh;
}

} // namespace tetrace
