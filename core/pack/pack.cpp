#include "core/base/error.h"
#include "core/mesh/entry_grid.h"
#include "core/mesh/tet_mesh.h"
#include "core/pack/hilbert.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace tetrace {
namespace {

Double3 unit_centroid(const Scene& scene, const Tet& tet)
{
    Double3 sum;
    for (const auto v : tet.vertices)
        sum = sum + to_double(scene.tets.vertices[v]);
    const Double3 low = to_double(scene.domain.low());
    const Double3 size = to_double(scene.domain.high()) - low;
    const Double3 offset = sum * 0.25 - low;
    return {offset.x / size.x, offset.y / size.y, offset.z / size.z};
}

// By the squares of areas.
double size_of(const TetMesh& mesh, const Tet& tet, std::uint32_t face)
{
    const auto at = [&](std::size_t i) { return to_double(mesh.vertices[tet.vertices[face_corners[face][i]]]); };
    const Double3 normal = cross(at(1) - at(0), at(2) - at(0));
    return dot(normal, normal);
}

// In chains that begin along the given order: a ray that leaves a tet goes on in the next one more often than anywhere
// else (docs/spec/layouts.md, L14). No chain leads from a tet that rays from outside reach to one that they do not.
std::vector<std::uint32_t> in_chains(const TetMesh& mesh, const std::vector<std::uint32_t>& tets)
{
    std::vector<bool> is_placed(tets.size());
    std::vector<std::uint32_t> chains;
    chains.reserve(tets.size());
    for (const std::uint32_t first : tets)
        for (std::uint32_t next = first; next != NO_TET && !is_placed[next];) {
            chains.push_back(next);
            is_placed[next] = true;
            const Tet& tet = mesh.tets[next];
            next = NO_TET;
            double largest = -1;
            for (std::uint32_t face = 0; face < 4; ++face) {
                const bool leads_on = tet.faces[face] == FREE_FACE && tet.neighbours[face] != NO_HALF_FACE &&
                                      !is_placed[half_face_tet(tet.neighbours[face])];
                const double size = leads_on ? size_of(mesh, tet, face) : -1;
                if (size > largest) next = half_face_tet(tet.neighbours[face]);
                largest = std::max(largest, size);
            }
        }
    return chains;
}

// The scene's tets in packed order.
std::vector<std::uint32_t> packing_order(const Scene& scene, TetOrder order)
{
    std::vector<std::uint32_t> tets(scene.tets.tets.size());
    std::iota(tets.begin(), tets.end(), 0u);
    if (order == TetOrder::input) return tets;
    std::vector<std::uint64_t> key(tets.size());
    std::ranges::transform(scene.tets.tets, key.begin(),
                           [&](const Tet& tet) { return hilbert_index(unit_centroid(scene, tet)); });
    std::ranges::stable_sort(tets, [&](auto a, auto b) { return key[a] < key[b]; });
    if (order == TetOrder::hilbert) return tets;
    const std::vector<bool> reached = reached_tets(scene.tets);
    std::stable_partition(tets.begin(), tets.end(), [&](auto tet) { return reached[tet]; });
    return order == TetOrder::reached ? tets : in_chains(scene.tets, tets);
}

std::uint32_t renumbered(std::uint32_t half_face, const std::vector<std::uint32_t>& packed_of_mesh)
{
    return half_face == NO_HALF_FACE
               ? NO_HALF_FACE
               : make_half_face(packed_of_mesh[half_face_tet(half_face)], half_face_index(half_face));
}

// The scene's tets in packed order, with half-faces in that numbering.
TetMesh in_packed_order(const TetMesh& mesh, const std::vector<std::uint32_t>& tets,
                        const std::vector<std::uint32_t>& packed_of_mesh)
{
    TetMesh result{mesh.vertices, {}};
    result.tets.reserve(tets.size());
    for (const auto index : tets) {
        Tet tet = mesh.tets[index];
        for (auto& half_face : tet.neighbours)
            half_face = renumbered(half_face, packed_of_mesh);
        result.tets.push_back(tet);
    }
    return result;
}

Quad quad_of(Float3 a)
{
    return {std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y), std::bit_cast<std::uint32_t>(a.z), 0};
}

Float3 edge(Float3 a, Float3 b)
{
    return {b.x - a.x, b.y - a.y, b.z - a.z};
}

void pack_triangles(PackedScene& packed, const TriangleMesh& mesh)
{
    for (const auto& [a, b, c] : mesh.triangles) {
        packed.triangles.push_back(quad_of(mesh.vertices[a]));
        packed.triangles.push_back(quad_of(edge(mesh.vertices[a], mesh.vertices[b])));
        packed.triangles.push_back(quad_of(edge(mesh.vertices[a], mesh.vertices[c])));
    }
}

void pack_domain(PackedScene& packed, const Scene& scene)
{
    packed.divisions = scene.domain.divisions;
    for (const auto& lines : scene.domain.lines)
        for (const float line : lines)
            packed.lines.push_back(std::bit_cast<std::uint32_t>(line));
    EntryGrid grid = make_entry_grid(scene.domain, scene.tets);
    packed.entry_ranges = std::move(grid.ranges);
    for (const auto half_face : grid.half_faces)
        packed.entry_half_faces.push_back(renumbered(half_face, packed.packed_of_mesh));
}

} // namespace

std::size_t PackedScene::bytes() const
{
    return (tets.size() + triangles.size() + vertices.size() + entry_faces.size() + nodes.size() +
            leaf_triangles.size()) *
               sizeof(Quad) +
           (lines.size() + entry_ranges.size() + entry_half_faces.size() + occlusive_faces.size()) *
               sizeof(std::uint32_t);
}

PackedDomain domain_of(const PackedScene& scene)
{
    PackedDomain domain{scene.divisions, {}, {}};
    if (scene.lines.empty()) return domain;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = axis * (std::size_t{scene.divisions} + 1);
        domain.low[static_cast<int>(axis)] = std::bit_cast<float>(scene.lines.at(first));
        domain.high[static_cast<int>(axis)] = std::bit_cast<float>(scene.lines.at(first + scene.divisions));
    }
    return domain;
}

PackedScene pack(const Scene& scene, Layout layout, TetOrder order)
{
    const LayoutTraits& traits = traits_of(layout);
    const auto* const pack_tets = std::get_if<PackTets*>(&traits.pack);
    if (pack_tets == nullptr)
        throw Error(ErrorKind::internal, "packing tets as " + std::string(traits.name) + ": no layout of tets");
    if (scene.tets.tets.size() > traits.most)
        throw Error(ErrorKind::unsupported, "packing " + scene.name + " as " + std::string(traits.name) + ": " +
                                                std::to_string(scene.tets.tets.size()) +
                                                " tets, its kernels reach at most " + std::to_string(traits.most));
    PackedScene packed;
    packed.layout = layout;
    packed.tet_count = static_cast<std::uint32_t>(scene.tets.tets.size());

    const auto tets = packing_order(scene, order);
    packed.packed_of_mesh.resize(tets.size());
    for (std::uint32_t position = 0; position < tets.size(); ++position)
        packed.packed_of_mesh[tets[position]] = position;
    pack_triangles(packed, scene.mesh);
    pack_domain(packed, scene);
    (*pack_tets)(packed, in_packed_order(scene.tets, tets, packed.packed_of_mesh));
    return packed;
}

} // namespace tetrace
