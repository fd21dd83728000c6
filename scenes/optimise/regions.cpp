#include "scenes/optimise/regions.h"

#include "core/mesh/tet_mesh.h"
#include "scenes/optimise/shape.h"

#include <algorithm>
#include <utility>

namespace tetrace {
namespace {

// Where a part is cut, as a share of its tets: it differs from one pass to the next, so that walls do.
constexpr std::array<double, 4> cuts = {0.5, 0.42, 0.58, 0.46};

Double3 corner_sum(const MeshArrays& mesh, std::uint32_t tet)
{
    const auto& [a, b, c, d] = mesh.tets[tet].vertices;
    return mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d];
}

double along(Double3 point, int axis)
{
    return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

int longest_axis(const MeshArrays& mesh, std::span<const std::uint32_t> tets)
{
    Double3 low{impossible, impossible, impossible}, high = low * -1.0;
    for (const std::uint32_t t : tets) {
        const Double3 at = corner_sum(mesh, t);
        low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
    }
    const Double3 size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

} // namespace

Regions::Regions(const MeshArrays& whole, std::uint32_t pass, std::size_t max_tets)
    : whole_(whole), pass_(pass), max_tets_(max_tets), position_(whole.tets.size(), NO_TET)
{
    for (std::uint32_t t = 0; t < whole.tets.size(); ++t)
        if (whole.states[t] == TetState::reached) tets_.push_back(t);
    if (!tets_.empty()) halve(0, tets_.size(), 0);
    for (std::uint32_t i = 0; i < tets_.size(); ++i)
        position_[tets_[i]] = i;
}

void Regions::halve(std::size_t begin, std::size_t end, std::uint32_t depth)
{
    const auto first = tets_.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = tets_.begin() + static_cast<std::ptrdiff_t>(end);
    const std::size_t count = end - begin;
    if (count <= max_tets_) {
        std::sort(first, last); // nth_element() leaves an order that is not the same in all libraries
        ends_.push_back(end);
        return;
    }
    const int axis = longest_axis(whole_, {first, last});
    const double share = cuts[(pass_ + depth) % cuts.size()];
    const std::size_t middle = begin + static_cast<std::size_t>(static_cast<double>(count) * share);
    std::vector<std::pair<double, std::uint32_t>> places;
    places.reserve(count);
    for (auto t = first; t != last; ++t)
        places.emplace_back(along(corner_sum(whole_, *t), axis), *t);
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(middle - begin), places.end());
    std::transform(places.begin(), places.end(), first, [](const auto& place) { return place.second; });
    places = {};
    halve(begin, middle, depth + 1);
    halve(middle, end, depth + 1);
}

// The tet's number in the region; NO_HALF_FACE if it is in another.
std::uint32_t Regions::local_half_face(std::size_t index, std::uint32_t half_face) const
{
    const std::size_t begin = index == 0 ? 0 : ends_[index - 1], position = position_[half_face_tet(half_face)];
    if (position < begin || position >= ends_[index]) return NO_HALF_FACE;
    return make_half_face(static_cast<std::uint32_t>(position - begin), half_face_index(half_face));
}

Region Regions::cut(std::size_t index, std::uint32_t since, std::uint32_t later, Scratch& scratch) const
{
    Region region;
    MeshArrays& mesh = region.mesh;
    scratch.place.resize(whole_.points.size(), NO_TET);
    std::vector<std::uint8_t> at_wall;
    const auto place = [&](std::uint32_t v) {
        if (scratch.place[v] == NO_TET) {
            scratch.place[v] = static_cast<std::uint32_t>(region.vertices.size());
            region.vertices.push_back(v);
            mesh.points.push_back(whole_.points[v]);
            mesh.kinds.push_back(whole_.kinds[v]);
            mesh.box_sides.push_back(whole_.box_sides[v]);
            mesh.vertex_changed.push_back(whole_.vertex_changed[v]);
            at_wall.push_back(0);
        }
        return scratch.place[v];
    };
    for (std::size_t i = index == 0 ? 0 : ends_[index - 1]; i < ends_[index]; ++i) {
        const std::uint32_t t = tets_[i];
        Tet tet = whole_.tets[t];
        for (std::uint32_t& v : tet.vertices)
            v = place(v);
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (tet.neighbours[face] == NO_HALF_FACE) continue;
            const std::uint32_t beyond =
                std::exchange(tet.neighbours[face], local_half_face(index, tet.neighbours[face]));
            if (tet.neighbours[face] != NO_HALF_FACE) continue;
            const auto wall = static_cast<std::uint32_t>(region.walls.size());
            region.walls.push_back(
                {make_half_face(t, face), beyond, std::exchange(tet.faces[face], Region::first_wall + wall)});
            if (whole_.states[half_face_tet(beyond)] != TetState::reached)
                continue; // an object's face: no tet waits across it
            for (const std::uint32_t corner : face_corners[face])
                at_wall[tet.vertices[corner]] = 1;
        }
        mesh.tets.push_back(tet);
        mesh.states.push_back(TetState::reached);
        mesh.tet_changed.push_back(whole_.tet_changed[t]);
    }
    for (std::size_t v = 0; v < at_wall.size(); ++v) {
        scratch.place[region.vertices[v]] = NO_TET;
        if (at_wall[v] == 0 || mesh.kinds[v] != VertexKind::free) continue;
        mesh.kinds[v] = VertexKind::at_wall;
        if (mesh.vertex_changed[v] >= since) mesh.vertex_changed[v] = later;
    }
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        int corners = 0; // an edge with both ends at walls may have tets on the other side
        for (const std::uint32_t v : mesh.tets[t].vertices)
            corners += at_wall[v];
        if (corners > 1 && mesh.tet_changed[t] >= since) mesh.tet_changed[t] = later;
    }
    return region;
}

namespace {

// Puts regions into a whole mesh of which only the hidden tets are left.
class Joiner {
public:
    explicit Joiner(MeshArrays& whole) : whole_(whole), moved_(4 * whole.tets.size(), NO_HALF_FACE) {}

    void add_hidden(const MeshArrays& old)
    {
        for (std::uint32_t t = 0; t < old.tets.size(); ++t) {
            if (old.states[t] != TetState::hidden) continue;
            for (std::uint32_t face = 0; face < 4; ++face) {
                moved_[make_half_face(t, face)] = make_half_face(next_tet(), face);
                if (old.tets[t].neighbours[face] != NO_HALF_FACE) open_.push_back(make_half_face(next_tet(), face));
            }
            add(old.tets[t], TetState::hidden, old.tet_changed[t]);
        }
    }

    void add(const Region& region)
    {
        const MeshArrays& mesh = region.mesh;
        const std::vector<std::uint32_t> vertex_place = add_vertices(region);
        std::vector<std::uint32_t> tet_place(mesh.tets.size());
        std::uint32_t next = next_tet();
        for (std::size_t t = 0; t < mesh.tets.size(); ++t)
            tet_place[t] = mesh.states[t] == TetState::unused ? NO_TET : next++;
        for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
            if (mesh.states[t] == TetState::unused) continue;
            Tet tet = mesh.tets[t];
            for (std::uint32_t& v : tet.vertices)
                v = vertex_place[v];
            for (std::uint32_t face = 0; face < 4; ++face) {
                std::uint32_t& half_face = tet.neighbours[face];
                if (half_face != NO_HALF_FACE) {
                    half_face = make_half_face(tet_place[half_face_tet(half_face)], half_face_index(half_face));
                } else if (tet.faces[face] != FREE_FACE && tet.faces[face] >= Region::first_wall) {
                    const Wall& wall = region.walls[tet.faces[face] - Region::first_wall];
                    moved_[wall.own] = make_half_face(tet_place[t], face);
                    open_.push_back(make_half_face(tet_place[t], face));
                    half_face = wall.beyond;
                    tet.faces[face] = wall.triangle;
                }
            }
            add(tet, TetState::reached, mesh.tet_changed[t]);
        }
    }

    // Half-faces of the old mesh become those of the new one.
    void close()
    {
        for (const std::uint32_t side : open_) {
            std::uint32_t& half_face = whole_.tets[half_face_tet(side)].neighbours[half_face_index(side)];
            half_face = moved_[half_face];
        }
    }

private:
    [[nodiscard]] std::uint32_t next_tet() const { return static_cast<std::uint32_t>(whole_.tets.size()); }

    void add(const Tet& tet, TetState state, std::uint32_t changed)
    {
        whole_.tets.push_back(tet);
        whole_.states.push_back(state);
        whole_.tet_changed.push_back(changed);
    }

    [[nodiscard]] std::vector<std::uint32_t> add_vertices(const Region& region)
    {
        const MeshArrays& mesh = region.mesh;
        std::vector<std::uint32_t> place = region.vertices;
        for (std::size_t v = 0; v < mesh.points.size(); ++v) {
            if (v == place.size()) {
                place.push_back(static_cast<std::uint32_t>(whole_.points.size()));
                whole_.points.push_back(mesh.points[v]);
                whole_.kinds.push_back(mesh.kinds[v]);
                whole_.box_sides.push_back(mesh.box_sides[v]);
                whole_.vertex_changed.push_back(mesh.vertex_changed[v]);
            } else if (mesh.kinds[v] == VertexKind::at_wall) {
                std::uint32_t& changed = whole_.vertex_changed[place[v]];
                changed = std::max(changed, mesh.vertex_changed[v]);
            } else if (whole_.kinds[place[v]] == VertexKind::free) {
                whole_.points[place[v]] = mesh.points[v];
                whole_.kinds[place[v]] = mesh.kinds[v];
                whole_.box_sides[place[v]] = mesh.box_sides[v];
                whole_.vertex_changed[place[v]] = mesh.vertex_changed[v];
            }
        }
        return place;
    }

    MeshArrays& whole_;
    std::vector<std::uint32_t> moved_; ///< per side of the old mesh that a tet across it names: that side now
    std::vector<std::uint32_t> open_;  ///< sides of the new mesh whose half-faces are of the old one
};

} // namespace

void Regions::join(MeshArrays& whole, std::vector<Region> regions)
{
    MeshArrays old;
    Joiner joiner(whole);
    std::swap(old.tets, whole.tets);
    std::swap(old.states, whole.states);
    std::swap(old.tet_changed, whole.tet_changed);
    joiner.add_hidden(old);
    old = {};
    for (Region& region : regions) {
        joiner.add(region);
        region = {};
    }
    joiner.close();
}

} // namespace tetrace
