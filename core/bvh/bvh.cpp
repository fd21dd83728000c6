#include "core/bvh/bvh.h"

namespace tetrace {
namespace {

using Defect = std::optional<std::string>;

std::string node_text(std::size_t node)
{
    return "node " + std::to_string(node) + ' ';
}

Defect child_defect(const Bvh& bvh, std::size_t parent, std::vector<bool>& is_child)
{
    for (const auto child : bvh.nodes[parent].child) {
        if (child <= parent || child >= bvh.nodes.size())
            return node_text(parent) + "has a child before it or past "
                                       "the last node";
        if (is_child[child]) return node_text(child) + "is a child twice";
        is_child[child] = true;
        if (!contains(bvh.nodes[parent].box, bvh.nodes[child].box))
            return node_text(child) + "has a box that is not in its parent's";
    }
    return {};
}

/// The references of a bvh as its leaves have them.
struct BvhCoverage {
    std::vector<bool> referred;   ///< by a leaf
    std::vector<Box> of_triangle; ///< the boxes of its leaves, merged
};

Defect leaf_defect(const Bvh& bvh, std::size_t leaf, BvhCoverage& coverage)
{
    const auto& [box, child, first, count] = bvh.nodes[leaf];
    if (std::uint64_t{first} + count > bvh.references.size()) return node_text(leaf) + "has references past the last";
    for (std::size_t i = first; i < std::size_t{first} + count; ++i) {
        const std::uint32_t triangle = bvh.references[i];
        if (coverage.referred[i]) return "reference " + std::to_string(i) + " is in two leaves";
        coverage.referred[i] = true;
        if (triangle >= coverage.of_triangle.size()) return node_text(leaf) + "names a triangle past the last";
        for (std::size_t j = first; j < i; ++j)
            if (bvh.references[j] == triangle) return node_text(leaf) + "names a triangle twice";
        coverage.of_triangle[triangle] = merged(coverage.of_triangle[triangle], box);
    }
    return {};
}

Defect coverage_defect(const BvhCoverage& coverage, const TriangleMesh& mesh)
{
    for (std::size_t i = 0; i < coverage.referred.size(); ++i)
        if (!coverage.referred[i]) return "reference " + std::to_string(i) + " is in no leaf";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (!contains(coverage.of_triangle[i], triangle_box(mesh, i)))
            return "triangle " + std::to_string(i) + " is not covered by the boxes of its leaves";
    return {};
}

} // namespace

std::uint32_t depth_of(const Bvh& bvh)
{
    std::vector<std::uint32_t> depth(bvh.nodes.size());
    std::uint32_t deepest = 0;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        if (bvh.nodes[i].count == 0)
            for (const auto child : bvh.nodes[i].child)
                depth[child] = depth[i] + 1;
    }
    return deepest;
}

std::optional<std::string> find_defect(const Bvh& bvh, const TriangleMesh& mesh)
{
    if (bvh.nodes.empty()) return "the root is missing";
    std::vector<bool> is_child(bvh.nodes.size());
    BvhCoverage coverage{std::vector<bool>(bvh.references.size()), std::vector<Box>(mesh.triangles.size())};
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        auto defect = bvh.nodes[i].count == 0 ? child_defect(bvh, i, is_child) : leaf_defect(bvh, i, coverage);
        if (defect) return defect;
        if (i > 0 && !is_child[i]) return node_text(i) + "is nobody's child";
    }
    return coverage_defect(coverage, mesh);
}

} // namespace tetrace
