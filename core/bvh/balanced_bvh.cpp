#include "core/bvh/balanced_bvh.h"

#include <numeric>
#include <span>

namespace tetrace {
namespace {

constexpr std::size_t max_balanced_leaf = 4; // triangles

class BalancedBuilder {
public:
    explicit BalancedBuilder(const TriangleMesh& mesh) : boxes_(mesh.triangles.size())
    {
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            boxes_[i] = triangle_box(mesh, i);
        bvh_.references.resize(boxes_.size());
        std::iota(bvh_.references.begin(), bvh_.references.end(), 0u);
    }

    Bvh build()
    {
        add(0, bvh_.references.size());
        return std::move(bvh_);
    }

private:
    std::uint32_t add(std::size_t first, std::size_t count)
    {
        const auto node = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes.emplace_back();
        if (count <= max_balanced_leaf) {
            bvh_.nodes[node].first = static_cast<std::uint32_t>(first);
            bvh_.nodes[node].count = static_cast<std::uint32_t>(count);
            for (std::size_t i = first; i < first + count; ++i)
                bvh_.nodes[node].box = merged(bvh_.nodes[node].box, boxes_[bvh_.references[i]]);
            return node;
        }
        halve(std::span(bvh_.references).subspan(first, count));
        const std::uint32_t left = add(first, count / 2);
        const std::uint32_t right = add(first + count / 2, count - count / 2);
        bvh_.nodes[node].child = {left, right};
        bvh_.nodes[node].box = merged(bvh_.nodes[left].box, bvh_.nodes[right].box);
        return node;
    }

    void halve(std::span<std::uint32_t> triangles) const
    {
        Box centres;
        for (const auto i : triangles)
            centres = merged(centres, {to_float(centre(boxes_[i])), to_float(centre(boxes_[i]))});
        const Double3 size = to_double(centres.high) - to_double(centres.low);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto key = [&](std::uint32_t i) {
            return std::pair(boxes_[i].low[axis] + boxes_[i].high[axis],
                             i); // equal ones by number: one order everywhere
        };
        std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2),
                         triangles.end(), [&](auto a, auto b) { return key(a) < key(b); });
    }

    std::vector<Box> boxes_;
    Bvh bvh_;
};

} // namespace

Bvh build_balanced_bvh(const TriangleMesh& mesh)
{
    return BalancedBuilder(mesh).build();
}

} // namespace tetrace
