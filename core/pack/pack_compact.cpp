#include "core/pack/pack_compact.h"

#include "core/base/error.h"
#include "core/mesh/face_corners.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <string>
#include <tuple>

namespace tetrace {
namespace {

using FourWords = std::array<std::uint32_t, 4>;

constexpr std::uint32_t not_numbered = 0xFFFFFFFFu;

[[noreturn]] void reject(Layout layout, const std::string& what)
{
    throw Error(ErrorKind::unsupported, "packing as " + std::string(name_of(layout)) + ": " + what);
}

bool has_vertex(const Tet& tet, std::uint32_t vertex)
{
    return std::find(tet.vertices.begin(), tet.vertices.end(), vertex) != tet.vertices.end();
}

/// Whether a walk that comes from the tet through the face knows three vertices of the next one.
bool is_named_back(const TetMesh& mesh, std::uint32_t tet, std::uint32_t face)
{
    const std::uint32_t link = mesh.tets[tet].links[face];
    const Tet& next = mesh.tets[link_tet(link)];
    if (next.links[link_face(link)] != make_link(tet, face)) return false;
    for (const std::uint32_t i : face_corners[face])
        if (!has_vertex(next, mesh.tets[tet].vertices[i])) return false;
    return !has_vertex(mesh.tets[tet], next.vertices[link_face(link)]);
}

void require_walkable(const TetMesh& mesh, Layout layout)
{
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); tet++)
        for (std::uint32_t face = 0; face < 4; face++) {
            const bool is_boundary = mesh.tets[tet].links[face] == NO_LINK;
            if (is_boundary && mesh.tets[tet].faces[face] != FREE_FACE)
                reject(layout, "tet " + std::to_string(tet) + " has an occlusive face on the domain's boundary");
            if (!is_boundary && !is_named_back(mesh, tet, face))
                reject(layout, "tet " + std::to_string(tet) + " and its neighbour behind face " + std::to_string(face) +
                                   " do not name each other");
        }
}

/// The number of each vertex of the mesh: in the order in which the tets first name them.
std::vector<std::uint32_t> number_vertices(const TetMesh& mesh)
{
    std::vector<std::uint32_t> number(mesh.vertices.size(), not_numbered);
    std::uint32_t count = 0;
    for (const Tet& tet : mesh.tets)
        for (const std::uint32_t vertex : tet.vertices)
            if (number[vertex] == not_numbered) number[vertex] = count++;
    return number;
}

/// Quads of the vertices that tets name, each with its rank in the order of is_before() (kernels/methods/signs.h).
std::vector<Quad> vertex_quads(const TetMesh& mesh, const std::vector<std::uint32_t>& number)
{
    std::vector<std::uint32_t> in_order;
    for (std::uint32_t i = 0; i < number.size(); i++)
        if (number[i] != not_numbered) in_order.push_back(i);
    const auto key = [&](std::uint32_t i) {
        return std::tuple(mesh.vertices[i].x, mesh.vertices[i].y, mesh.vertices[i].z);
    };
    std::sort(in_order.begin(), in_order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    std::vector<Quad> quads(in_order.size());
    for (std::uint32_t rank = 0; rank < in_order.size(); rank++) {
        const Float3 at = mesh.vertices[in_order[rank]];
        quads[number[in_order[rank]]] = {std::bit_cast<std::uint32_t>(at.x), std::bit_cast<std::uint32_t>(at.y),
                                         std::bit_cast<std::uint32_t>(at.z), FIRST_RANK + rank};
    }
    return quads;
}

FourWords numbered(const Tet& tet, const std::vector<std::uint32_t>& number)
{
    FourWords vertices;
    std::transform(tet.vertices.begin(), tet.vertices.end(), vertices.begin(), [&](auto v) { return number[v]; });
    return vertices;
}

/// What is behind each face of each tet, as layout.h has it; fills the table of occlusive faces.
std::vector<FourWords> words_behind(const TetMesh& mesh, std::vector<std::uint32_t>& occlusive_faces, Layout layout)
{
    std::vector<FourWords> behind(mesh.tets.size());
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); tet++)
        for (std::uint32_t face = 0; face < 4; face++) {
            const std::uint32_t link = mesh.tets[tet].links[face];
            const std::uint32_t triangle = mesh.tets[tet].faces[face];
            if (link == NO_LINK || triangle == FREE_FACE) {
                behind[tet][face] = link == NO_LINK ? NO_LINK : link_tet(link);
            } else if (tet < link_tet(link)) {
                const std::size_t side = 2 * (occlusive_faces.size() / OCCLUSIVE_WORDS);
                if (side >= OCCLUSIVE - 2) reject(layout, "more than 1,073,741,823 occlusive faces");
                occlusive_faces.insert(occlusive_faces.end(), {triangle, tet, link_tet(link)});
                behind[tet][face] = OCCLUSIVE | static_cast<std::uint32_t>(side);
                behind[link_tet(link)][link_face(link)] = OCCLUSIVE | static_cast<std::uint32_t>(side + 1);
            }
        }
    return behind;
}

/// What is behind the faces, by the numbers of the vertices opposite to them.
FourWords sorted_by(const FourWords& vertices, const FourWords& behind)
{
    std::array<std::uint32_t, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return vertices[a] < vertices[b]; });
    return {behind[order[0]], behind[order[1]], behind[order[2]], behind[order[3]]};
}

std::uint32_t xor_of(const FourWords& words)
{
    return words[0] ^ words[1] ^ words[2] ^ words[3];
}

std::vector<Quad> quads_of_words(std::vector<std::uint32_t> words)
{
    words.resize((words.size() + 3) / 4 * 4);
    std::vector<Quad> quads;
    for (std::size_t i = 0; i < words.size(); i += 4)
        quads.push_back({words[i], words[i + 1], words[i + 2], words[i + 3]});
    return quads;
}

void add_tet(std::vector<std::uint32_t>& words, Layout layout, std::uint32_t vertices, const FourWords& behind)
{
    if (layout == Layout::tet20)
        words.insert(words.end(), {vertices, behind[0], behind[1], behind[2], behind[3]});
    else
        words.insert(words.end(), {vertices, behind[0] ^ behind[3], behind[1] ^ behind[3], behind[2] ^ behind[3]});
}

void name_entry_faces(PackedScene& packed, const TetMesh& mesh)
{
    for (const std::uint32_t link : packed.entry_links) {
        const FourWords vertices = numbered(mesh.tets[link_tet(link)], packed.number_of_vertex);
        const auto& corners = face_corners[link_face(link)];
        packed.entry_faces.push_back(
            {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], link_tet(link)});
    }
    packed.entry_links.clear();
}

/// What is read back of a packed tet.
struct Decoded {
    FourWords vertices{}; ///< in the orientation of tet_mesh.h
    FourWords behind{};   ///< the face opposite each
    bool is_known = false;
};

/// A tet that is known by a face of it.
struct Seen {
    std::uint32_t tet;
    std::array<std::uint32_t, 3> face; ///< its vertices in the order of face_corners, for this tet
    std::uint32_t behind;              ///< what the tet names behind it
};

/// Goes from the boundary through all tets, as a walk does.
class Decoder {
public:
    explicit Decoder(const PackedScene& packed) : packed_(packed), tets_(packed.tet_count) {}

    std::vector<Decoded> decode()
    {
        for (const Quad& face : packed_.entry_faces)
            see({face.w, {face.x, face.y, face.z}, NO_LINK});
        while (!waiting_.empty()) {
            const Seen seen = waiting_.back();
            waiting_.pop_back();
            if (!tets_[seen.tet].is_known) enter(seen);
        }
        for (const Decoded& tet : tets_)
            require(tet.is_known);
        return std::move(tets_);
    }

private:
    static void require(bool holds)
    {
        if (!holds) throw Error(ErrorKind::invalid_input, "unpacking compact tets: their words contradict each other");
    }
    [[nodiscard]] std::uint32_t word(std::size_t index) const
    {
        const Quad& quad = packed_.tets.at(index / 4);
        return FourWords{quad.x, quad.y, quad.z, quad.w}[index % 4];
    }
    void see(const Seen& seen)
    {
        require(seen.tet < tets_.size());
        waiting_.push_back(seen);
    }
    /// What is behind each of the tet's faces, where `known` is behind that of `known_rank`.
    [[nodiscard]] FourWords behind_ranks(std::uint32_t tet, std::size_t known_rank, std::uint32_t known) const
    {
        const std::size_t first = std::size_t{tet} * (packed_.layout == Layout::tet20 ? TET20_WORDS : 4);
        FourWords behind{word(first + 1), word(first + 2), word(first + 3), 0};
        if (packed_.layout == Layout::tet20)
            behind[3] = word(first + 4);
        else
            for (std::uint32_t& one : behind)
                one ^= FourWords{word(first + 1), word(first + 2), word(first + 3), 0}[known_rank] ^ known;
        require(behind[known_rank] == known);
        return behind;
    }
    void enter(const Seen& seen);
    void look_behind(std::uint32_t tet, std::uint32_t face);

    const PackedScene& packed_;
    std::vector<Decoded> tets_;
    std::vector<Seen> waiting_;
};

void Decoder::enter(const Seen& seen)
{
    const auto& [a, b, c] = seen.face;
    const std::size_t first = std::size_t{seen.tet} * (packed_.layout == Layout::tet20 ? TET20_WORDS : 4);
    const std::uint32_t apex = word(first) ^ a ^ b ^ c;
    require(apex < packed_.vertices.size() && apex != a && apex != b && apex != c);
    Decoded& tet = tets_[seen.tet];
    tet.vertices = {apex, a, b, c}; // face 0 has corners 1, 2, 3
    FourWords sorted = tet.vertices;
    std::sort(sorted.begin(), sorted.end());
    const auto rank = [&](std::uint32_t v) {
        return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin());
    };
    const FourWords behind = behind_ranks(seen.tet, rank(apex), seen.behind);
    for (std::size_t i = 0; i < 4; i++)
        tet.behind[i] = behind[rank(tet.vertices[i])];
    tet.is_known = true;
    for (std::uint32_t face = 1; face < 4; face++)
        look_behind(seen.tet, face);
}

void Decoder::look_behind(std::uint32_t tet, std::uint32_t face)
{
    const std::uint32_t behind = tets_[tet].behind[face];
    if (behind == NO_LINK) return;
    const auto vertex = [&](std::size_t i) { return tets_[tet].vertices[face_corners[face][i]]; };
    Seen seen{behind, {vertex(0), vertex(2), vertex(1)}, tet};
    if (behind >= OCCLUSIVE) {
        const std::uint32_t other_side = (behind ^ OCCLUSIVE) ^ 1u;
        const std::size_t index = std::size_t{OCCLUSIVE_WORDS} * (other_side / 2) + 1 + other_side % 2;
        require(index < packed_.occlusive_faces.size());
        seen.tet = packed_.occlusive_faces[index];
        seen.behind = OCCLUSIVE | other_side;
    }
    see(seen);
}

/// The face of the tet that has none but these vertices.
std::uint32_t face_with(const Decoded& tet, const Decoded& other, std::uint32_t other_face)
{
    for (std::uint32_t face = 0; face < 4; face++) {
        const auto is_shared = [&](std::uint32_t i) {
            const auto end = other.vertices.end();
            return i == face || (tet.vertices[i] != other.vertices[other_face] &&
                                 std::find(other.vertices.begin(), end, tet.vertices[i]) != end);
        };
        if (is_shared(0) && is_shared(1) && is_shared(2) && is_shared(3)) return face;
    }
    throw Error(ErrorKind::invalid_input, "unpacking compact tets: neighbours that share no face");
}

Tet linked(const PackedScene& packed, const std::vector<Decoded>& tets, const Decoded& tet)
{
    Tet result{tet.vertices, {}, {}};
    for (std::uint32_t face = 0; face < 4; face++) {
        std::uint32_t behind = tet.behind[face];
        result.links[face] = NO_LINK;
        result.faces[face] = FREE_FACE;
        if (behind == NO_LINK) continue;
        if (behind >= OCCLUSIVE) {
            const std::size_t first = std::size_t{OCCLUSIVE_WORDS} * ((behind ^ OCCLUSIVE) / 2);
            result.faces[face] = packed.occlusive_faces[first];
            behind = packed.occlusive_faces[first + 1 + ((behind & 1u) ^ 1u)];
        }
        result.links[face] = make_link(behind, face_with(tets[behind], tet, face));
    }
    return result;
}

} // namespace

void pack_compact(PackedScene& packed, const TetMesh& mesh)
{
    require_walkable(mesh, packed.layout);
    packed.number_of_vertex = number_vertices(mesh);
    packed.vertices = vertex_quads(mesh, packed.number_of_vertex);
    const std::vector<FourWords> behind = words_behind(mesh, packed.occlusive_faces, packed.layout);
    std::vector<std::uint32_t> words;
    for (std::size_t tet = 0; tet < mesh.tets.size(); tet++) {
        const FourWords vertices = numbered(mesh.tets[tet], packed.number_of_vertex);
        const FourWords sorted = sorted_by(vertices, behind[tet]);
        add_tet(words, packed.layout, xor_of(vertices), sorted);
        packed.last_neighbours.push_back(sorted[3]);
    }
    packed.tets = quads_of_words(std::move(words));
    name_entry_faces(packed, mesh);
}

TetMesh unpack_compact(const PackedScene& packed)
{
    TetMesh mesh;
    for (const Quad& vertex : packed.vertices)
        mesh.vertices.push_back(
            {std::bit_cast<float>(vertex.x), std::bit_cast<float>(vertex.y), std::bit_cast<float>(vertex.z)});
    const std::vector<Decoded> tets = Decoder(packed).decode();
    for (const Decoded& tet : tets)
        mesh.tets.push_back(linked(packed, tets, tet));
    return mesh;
}

} // namespace tetrace
