#pragma once

#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <tuple>

namespace tetrace::test {

namespace unpacking {

using FourWords = std::array<std::uint32_t, 4>;

// Words of a tet that holds its corners: the places of vertex coordinates and faces.
struct WordMap {
    std::uint32_t vertex_stride, first_face;
};
inline WordMap words_of(Layout layout)
{
    return layout == Layout::tet80 ? WordMap{3, 12} : WordMap{4, 16};
}

inline std::uint32_t word(const std::vector<Quad>& quads, std::size_t index)
{
    const Quad& quad = quads.at(index / 4);
    return index % 4 == 0 ? quad.x : index % 4 == 1 ? quad.y : index % 4 == 2 ? quad.z : quad.w;
}

inline TetMesh unpack_corners(const PackedScene& packed)
{
    const WordMap map = words_of(packed.layout);
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> index;
    TetMesh mesh;
    mesh.tets.resize(packed.tet_count);
    for (std::size_t position = 0; position < packed.tet_count; ++position) {
        const std::size_t first = position * (map.first_face + 8);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t at = first + map.vertex_stride * i;
            const std::tuple key(word(packed.tets, at), word(packed.tets, at + 1), word(packed.tets, at + 2));
            const auto [entry, is_new] = index.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new)
                mesh.vertices.push_back({std::bit_cast<float>(std::get<0>(key)), std::bit_cast<float>(std::get<1>(key)),
                                         std::bit_cast<float>(std::get<2>(key))});
            mesh.tets[position].vertices[i] = entry->second;
            mesh.tets[position].neighbours[i] = word(packed.tets, first + map.first_face + 2 * i);
            mesh.tets[position].faces[i] = word(packed.tets, first + map.first_face + 2 * i + 1);
        }
    }
    return mesh;
}

// The triangle that an exit ends at; FREE_FACE where it does not, and at the domain's boundary.
inline std::uint32_t triangle_at(std::uint32_t exit)
{
    return (exit & 3u) == EXIT_END && exit != NO_HALF_FACE ? exit >> 2 : FREE_FACE;
}

// Whether the neighbour across a face has that face as its own; the domain's boundary always has.
inline bool is_named_back(const TetMesh& mesh, std::uint32_t face)
{
    const std::uint32_t half_face = mesh.tets[half_face_tet(face)].neighbours[half_face_index(face)];
    return half_face == NO_HALF_FACE ||
           (half_face_tet(half_face) < mesh.tets.size() &&
            mesh.tets[half_face_tet(half_face)].neighbours[half_face_index(half_face)] == face);
}

[[noreturn]] inline void reject(std::size_t record, const char* why)
{
    throw Error(ErrorKind::internal, "record " + std::to_string(record) + ": " + why);
}

// Whether the tets on both sides of a face have its three vertices.
inline bool shares_vertices(const TetMesh& mesh, std::uint32_t face)
{
    const Tet& tet = mesh.tets[half_face_tet(face)];
    if (tet.neighbours[half_face_index(face)] == NO_HALF_FACE) return true;
    const auto& others = mesh.tets[half_face_tet(tet.neighbours[half_face_index(face)])].vertices;
    return std::ranges::all_of(face_corners[half_face_index(face)], [&](std::uint32_t corner) {
        return std::ranges::find(others, tet.vertices[corner]) != others.end();
    });
}

inline void require_neighbours(const TetMesh& mesh)
{
    for (std::uint32_t record = 0; record < 4 * mesh.tets.size(); ++record)
        if (!is_named_back(mesh, record)) reject(record, "its neighbour does not lead back");
    for (std::uint32_t record = 0; record < 4 * mesh.tets.size(); ++record)
        if (!shares_vertices(mesh, record)) reject(record, "its neighbour has other vertices");
}

inline void require_same(const std::vector<Quad>& quads, const std::vector<Quad>& again, std::size_t stride)
{
    const auto differing = std::mismatch(quads.begin(), quads.end(), again.begin(), again.end()).first;
    if (differing != quads.end() || quads.size() != again.size())
        reject(static_cast<std::size_t>(differing - quads.begin()) / stride,
               "it contradicts the others of its tet, or those of its neighbours");
}

// Numbers positions in the order of their first use.
class Places {
public:
    explicit Places(std::vector<Float3>& vertices) : vertices_(vertices) {}
    std::uint32_t number_of(const Quad& quad)
    {
        const auto [place, is_new] =
            index_.try_emplace({quad.x, quad.y, quad.z}, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new)
            vertices_.push_back(
                {std::bit_cast<float>(quad.x), std::bit_cast<float>(quad.y), std::bit_cast<float>(quad.z)});
        return place->second;
    }

private:
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> index_;
    std::vector<Float3>& vertices_;
};

inline TetMesh unpack_half32(const std::vector<Quad>& records)
{
    TetMesh mesh;
    Places places(mesh.vertices);
    mesh.tets.resize(records.size() / (4 * HALF32_QUADS));
    for (std::size_t record = 0; record < 4 * mesh.tets.size(); ++record) {
        Tet& tet = mesh.tets[record / 4];
        const std::size_t entry = record % 4;
        const Quad &apex = records[HALF32_QUADS * record], &exits = records[HALF32_QUADS * record + 1];
        tet.vertices[entry] = places.number_of(apex);
        tet.neighbours[entry] = exits.w;
        const auto& faces = face_corners[entry];
        tet.faces[faces[0]] = triangle_at(exits.x);
        tet.faces[faces[1]] = triangle_at(exits.y);
        tet.faces[faces[2]] = triangle_at(exits.z);
    }
    require_neighbours(mesh);
    PackedScene again;
    pack_half32(again, mesh);
    require_same(records, again.tets, HALF32_QUADS);
    return mesh;
}

inline TetMesh unpack_tet64(const PackedScene& packed)
{
    TetMesh mesh;
    Places places(mesh.vertices);
    mesh.tets.resize(packed.tets.size() / 4);
    PackedScene again;
    for (std::uint32_t record = 0; record < packed.tets.size(); ++record) {
        Tet& tet = mesh.tets[record / 4];
        const Quad& quad = packed.tets[record];
        const std::uint32_t behind = (quad.w & (EXIT_IS_NORMAL - 1)) >> 2;
        tet.vertices[record % 4] = places.number_of(quad);
        tet.neighbours[record % 4] = quad.w == NO_HALF_FACE ? NO_HALF_FACE : behind;
        tet.faces[record % 4] = FREE_FACE;
        if (quad.w == NO_HALF_FACE || (quad.w & 3) != EXIT_END) continue;
        if (packed.triangles.size() < TRIANGLE_QUADS * (std::size_t{behind} + 1)) reject(record, "it names no row");
        const Quad* const row = &packed.triangles[std::size_t{TRIANGLE_QUADS} * behind];
        const std::uint32_t triangle = row[0].w - NORMAL_BIAS;
        const std::uint32_t half_face = row[1].w == (EXIT_IS_NORMAL | record) ? row[2].w : row[1].w;
        tet.neighbours[record % 4] = half_face == NO_HALF_FACE ? NO_HALF_FACE : half_face & (EXIT_IS_NORMAL - 1);
        tet.faces[record % 4] = triangle;
        if (triangle > packed.triangles.size()) reject(record, "its row names no triangle");
        again.triangles.resize(std::max(again.triangles.size(), TRIANGLE_QUADS * (std::size_t{triangle} + 1)));
        std::copy_n(row, TRIANGLE_QUADS, &again.triangles[std::size_t{TRIANGLE_QUADS} * triangle]);
    }
    require_neighbours(mesh);
    pack_tet64(again, mesh);
    require_same(packed.tets, again.tets, 1);
    require_same(packed.triangles, again.triangles, TRIANGLE_QUADS);
    return mesh;
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
    std::uint32_t behind;              ///< what the tet names across it
};

/// Goes from the boundary through all tets, as a walk does.
class Decoder {
public:
    explicit Decoder(const PackedScene& packed) : packed_(packed), tets_(packed.tet_count) {}

    std::vector<Decoded> decode()
    {
        for (const Quad& face : packed_.entry_faces)
            see({face.w, {face.x, face.y, face.z}, NO_HALF_FACE});
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
    /// What is across each of the tet's faces; `known` is across that of `known_rank`.
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

inline void Decoder::enter(const Seen& seen)
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
    for (std::size_t i = 0; i < 4; ++i)
        tet.behind[i] = behind[rank(tet.vertices[i])];
    tet.is_known = true;
    for (std::uint32_t face = 1; face < 4; ++face)
        look_behind(seen.tet, face);
}

inline void Decoder::look_behind(std::uint32_t tet, std::uint32_t face)
{
    const std::uint32_t behind = tets_[tet].behind[face];
    if (behind == NO_HALF_FACE) return;
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
inline std::uint32_t face_with(const Decoded& tet, const Decoded& other, std::uint32_t other_face)
{
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto is_shared = [&](std::uint32_t i) {
            const auto end = other.vertices.end();
            return i == face || (tet.vertices[i] != other.vertices[other_face] &&
                                 std::find(other.vertices.begin(), end, tet.vertices[i]) != end);
        };
        if (is_shared(0) && is_shared(1) && is_shared(2) && is_shared(3)) return face;
    }
    throw Error(ErrorKind::invalid_input, "unpacking compact tets: neighbours that share no face");
}

inline Tet linked(const PackedScene& packed, const std::vector<Decoded>& tets, const Decoded& tet)
{
    Tet result{tet.vertices, {}, {}};
    for (std::uint32_t face = 0; face < 4; ++face) {
        std::uint32_t behind = tet.behind[face];
        result.neighbours[face] = NO_HALF_FACE;
        result.faces[face] = FREE_FACE;
        if (behind == NO_HALF_FACE) continue;
        if (behind >= OCCLUSIVE) {
            const std::size_t first = std::size_t{OCCLUSIVE_WORDS} * ((behind ^ OCCLUSIVE) / 2);
            result.faces[face] = packed.occlusive_faces[first];
            behind = packed.occlusive_faces[first + 1 + ((behind & 1u) ^ 1u)];
        }
        result.neighbours[face] = make_half_face(behind, face_with(tets[behind], tet, face));
    }
    return result;
}

inline TetMesh unpack_compact(const PackedScene& packed)
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

} // namespace unpacking

/// The tets of a packed scene again, in packed order: half-faces, faces and coordinates as they were, bit for bit, and
/// one vertex per position; of tet20 and tet16 with the same vertices, in whichever order gives them their orientation.
/// Throws Error if the words of half32, tet64, tet20 or tet16 contradict each other.
[[nodiscard]] inline TetMesh unpack(const PackedScene& packed)
{
    if (packed.layout == Layout::half32) return unpacking::unpack_half32(packed.tets);
    if (packed.layout == Layout::tet64) return unpacking::unpack_tet64(packed);
    return is_compact(packed.layout) ? unpacking::unpack_compact(packed) : unpacking::unpack_corners(packed);
}

} // namespace tetrace::test
