#include "core/pack/pack_bvh.h"

#include "core/base/error.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <bit>

namespace tetrace {

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

std::vector<std::uint32_t> triangles_of_leaf(const WideBvh& wide, const WideChild& leaf)
{
    const auto references = std::span(wide.references).subspan(leaf.first, leaf.count);
    std::vector<std::uint32_t> triangles(references.begin(), references.end());
    std::ranges::sort(triangles);
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
}

Box grown_box(const WideChild& child)
{
    return grown(child.box, BOX_MARGIN);
}

void refuse_to_pack(Layout layout, std::uint64_t found, const char* what, std::uint64_t most)
{
    throw Error(ErrorKind::unsupported, "packing a BVH as " + std::string(name_of(layout)) + ": " +
                                            std::to_string(found) + ' ' + what + ", but its kernels support at most " +
                                            std::to_string(most) + "; use a smaller mesh");
}

PackedScene pack_bvh(const TriangleMesh& mesh, const Bvh& bvh, Layout layout)
{
    const LayoutTraits& traits = traits_of(layout);
    const auto* const pack_nodes = std::get_if<PackBvh*>(&traits.pack);
    if (pack_nodes == nullptr)
        throw Error(ErrorKind::internal, "packing a BVH as " + std::string(traits.name) + ": no layout of BVHs");
    if (bvh.references.size() > traits.most)
        refuse_to_pack(layout, bvh.references.size(), "references of leaves to triangles", traits.most);
    for (const auto& node : bvh.nodes)
        if (node.count > max_leaf_references)
            refuse_to_pack(layout, node.count, "triangles in a leaf", max_leaf_references);
    PackedScene packed = (*pack_nodes)(mesh, bvh);
    packed.layout = layout;
    return packed;
}

} // namespace tetrace
