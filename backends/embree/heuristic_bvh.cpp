#include "backends/embree/heuristic_bvh.h"

#include "backends/embree/accelerator.h"
#include "core/base/error.h"

#include <memory>
#include <new>

namespace tetrace {
namespace {

constexpr unsigned max_in_leaf = 4; // triangles
/// Embree halves by number, whatever the heuristic says, from this many levels above its limit on.
constexpr unsigned embrees_last_levels = 8;

/// A node in the memory of Embree's BVH.
struct EmbreeNode {
    EmbreeNode* child[2] = {};
    RTCBuildPrimitive* primitives = nullptr; ///< of a leaf: boxes of the parts of its triangles
    std::size_t count = 0;                   ///< of a leaf
};

void* new_inner_node(RTCThreadLocalAllocator allocator, unsigned, void*)
{
    return new (rtcThreadLocalAlloc(allocator, sizeof(EmbreeNode), 16)) EmbreeNode;
}

void set_children(void* node, void** children, unsigned count, void*)
{
    for (unsigned i = 0; i < count; ++i)
        static_cast<EmbreeNode*>(node)->child[i] = static_cast<EmbreeNode*>(children[i]);
}

void* new_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*)
{
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(EmbreeNode), 16)) EmbreeNode;
    leaf->primitives =
        static_cast<RTCBuildPrimitive*>(rtcThreadLocalAlloc(allocator, count * sizeof(RTCBuildPrimitive), 32));
    leaf->count = count;
    std::uninitialized_copy_n(primitives, count, leaf->primitives);
    return leaf;
}

Box box_of(const RTCBuildPrimitive& p)
{
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

void set_bounds(RTCBounds& bounds, const Box& box)
{
    bounds.lower_x = box.low.x, bounds.lower_y = box.low.y, bounds.lower_z = box.low.z;
    bounds.upper_x = box.high.x, bounds.upper_y = box.high.y, bounds.upper_z = box.high.z;
}

void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* mesh)
{
    const auto& [vertices, triangles] = *static_cast<const TriangleMesh*>(mesh);
    const auto& [a, b, c] = triangles[primitive->primID];
    const auto parts =
        split_triangle({vertices[a], vertices[b], vertices[c]}, static_cast<int>(axis), position, box_of(*primitive));
    set_bounds(*left, parts.below);
    set_bounds(*right, parts.above);
}

std::vector<RTCBuildPrimitive> build_primitives(const TriangleMesh& mesh)
{
    std::vector<RTCBuildPrimitive> primitives(2 * mesh.triangles.size() + 1); // space for spatial splits
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Box box = triangle_box(mesh, i);
        primitives[i] = {box.low.x, box.low.y, box.low.z, 0, box.high.x, box.high.y, box.high.z, i};
    }
    return primitives;
}

/// Embree's tree, depth first; boxes are recomputed from those of the parts in the leaves.
class BvhCollector {
public:
    std::uint32_t add(const EmbreeNode& built)
    {
        const auto node = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes.emplace_back();
        if (built.count > 0) {
            add_leaf(bvh_.nodes[node], built);
            return node;
        }
        const std::uint32_t left = add(*built.child[0]);
        const std::uint32_t right = add(*built.child[1]);
        bvh_.nodes[node].child = {left, right};
        bvh_.nodes[node].box = merged(bvh_.nodes[left].box, bvh_.nodes[right].box);
        return node;
    }
    Bvh take() { return std::move(bvh_); }

private:
    // In order of their numbers, and only once if both parts of a triangle are in the same leaf.
    void add_leaf(BvhNode& leaf, const EmbreeNode& built)
    {
        std::vector<std::uint32_t> triangles;
        for (std::size_t i = 0; i < built.count; ++i) {
            triangles.push_back(built.primitives[i].primID);
            leaf.box = merged(leaf.box, box_of(built.primitives[i]));
        }
        std::ranges::sort(triangles);
        triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        leaf.first = static_cast<std::uint32_t>(bvh_.references.size());
        leaf.count = static_cast<std::uint32_t>(triangles.size());
        bvh_.references.insert(bvh_.references.end(), triangles.begin(), triangles.end());
    }

    Bvh bvh_;
};

struct EmbreeRelease {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

RTCBuildArguments build_arguments(RTCBVH bvh, std::vector<RTCBuildPrimitive>& primitives, const TriangleMesh& mesh,
                                  std::uint32_t max_depth)
{
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
    arguments.maxDepth = max_depth + embrees_last_levels; // a tree that is not too deep comes only from the heuristic
    arguments.maxLeafSize = max_in_leaf;
    arguments.bvh = bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = mesh.triangles.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = new_inner_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = [](void*, const RTCBounds**, unsigned, void*) {};
    arguments.createLeaf = new_leaf;
    arguments.splitPrimitive = split_primitive;
    arguments.userPtr = const_cast<TriangleMesh*>(&mesh); // split_primitive only reads it
    return arguments;
}

/// Nothing if the tree would be deeper than Embree was told.
std::optional<Bvh> build_with_embree(const TriangleMesh& mesh, unsigned threads, std::uint32_t max_depth)
{
    const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
    const std::unique_ptr<RTCDeviceTy, EmbreeRelease> device(rtcNewDevice(config.c_str()));
    if (device == nullptr) throw Error(ErrorKind::internal, "Embree: no device could be made");
    const std::unique_ptr<RTCBVHTy, EmbreeRelease> bvh(rtcNewBVH(device.get()));
    auto primitives = build_primitives(mesh);
    const auto arguments = build_arguments(bvh.get(), primitives, mesh, max_depth);
    const auto* root = static_cast<const EmbreeNode*>(rtcBuildBVH(&arguments));
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw Error(ErrorKind::unsupported, "building a BVH of " + std::to_string(mesh.triangles.size()) +
                                                " triangles: Embree is out of memory; free some, or take fewer");
    if (error != RTC_ERROR_NONE || root == nullptr) return {};
    BvhCollector collector;
    collector.add(*root);
    return collector.take();
}

} // namespace

HeuristicBvh build_heuristic_bvh(const TriangleMesh& mesh, unsigned threads, std::uint32_t max_depth)
{
    auto bvh = build_with_embree(mesh, threads, max_depth);
    if (bvh && depth_of(*bvh) <= max_depth) return {std::move(bvh), ""};
    return {{},
            "by the surface area heuristic more than " + std::to_string(max_depth) + " nodes would be above a leaf"};
}

} // namespace tetrace
