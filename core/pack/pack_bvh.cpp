#include "core/pack/pack_bvh.h"

#include "core/base/error.h"
#include "kernels/layouts/layout.h"

#include <bit>

namespace tetrace {

std::uint32_t most_references(Layout layout)
{
    if (layout == Layout::bvh2) return BVH2_LEAF >> 4;
    return 0xFFFFFFFFu / LEAF_TRIANGLE_QUADS; // kernels number quads with 32 bits
}

std::uint32_t add_leaf_triangles(PackedScene& packed, const TriangleMesh& mesh,
                                 std::span<const std::uint32_t> triangles)
{
    const auto first = static_cast<std::uint32_t>(packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS);
    for (const auto triangle : triangles) {
        std::uint32_t last_word = triangle;
        for (const auto v : mesh.triangles[triangle]) {
            const Float3 a = mesh.vertices[v];
            packed.leaf_triangles.push_back({std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y),
                                             std::bit_cast<std::uint32_t>(a.z), last_word});
            last_word = 0;
        }
    }
    return first;
}

void refuse_to_pack(Layout layout, std::uint64_t found, const char* what, std::uint64_t most)
{
    throw Error(ErrorKind::unsupported, "packing a BVH as " + std::string(name_of(layout)) + ": " +
                                            std::to_string(found) + ' ' + what + ", its kernels have room for " +
                                            std::to_string(most) + "; use a smaller mesh");
}

PackedScene pack_bvh(const TriangleMesh& mesh, const Bvh& bvh, Layout layout)
{
    if (layout != Layout::bvh2 && layout != Layout::cwbvh)
        throw Error(ErrorKind::internal, "packing a BVH as " + std::string(name_of(layout)) + ": no layout of BVHs");
    if (bvh.references.size() > most_references(layout))
        refuse_to_pack(layout, bvh.references.size(), "references of leaves to triangles", most_references(layout));
    for (const auto& node : bvh.nodes)
        if (node.count > most_leaf_references)
            refuse_to_pack(layout, node.count, "triangles in a leaf", most_leaf_references);
    PackedScene packed = layout == Layout::bvh2 ? pack_bvh2(mesh, bvh) : pack_cwbvh(mesh, bvh);
    packed.layout = layout;
    return packed;
}

} // namespace tetrace
