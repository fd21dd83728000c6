// The body of bvh2's loop: through nodes to a leaf, then through the leaf's triangles. It has the variables of
// trace_ray().
{
    if ((child & BVH2_LEAF) == 0u) {
        do {
            COUNT_NODE();
#ifdef HOST_SSE2
#include "kernels/bvh/bvh2_node_sse2.h"
#else
            uint4 xy_a = FETCH(scene, nodes, BVH2_NODE_QUADS * child);
            uint4 xy_b = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 1u);
            uint4 z = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 2u);
            uint4 children = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 3u);
            real a = box_entry(frame, nearest.limit, xy_a.x, xy_a.y, xy_a.z, xy_a.w, z.x, z.y);
            real b = box_entry(frame, nearest.limit, xy_b.x, xy_b.y, xy_b.z, xy_b.w, z.z, z.w);
            bool b_first = b < a;
            // BVH2_LEAF by itself is an empty leaf: the ray enters neither box.
            child = minimum(a, b) == NEVER ? BVH2_LEAF : b_first ? children.y : children.x;
            uint later = b_first ? children.x : children.y;
            SET_ENTRY(scene, stack, waiting, later, as_bits(maximum(a, b)))
            waiting += maximum(a, b) < NEVER ? 1u : 0u;
#endif
        } while ((child & BVH2_LEAF) == 0u);
    }
    if (child != BVH2_END) {
        uint at = (child & ~BVH2_LEAF) >> 4u;
        uint behind = at + (child & 15u);
        if (at < behind) {
            do {
                nearest = nearer_triangle(scene, frame, nearest, at);
                ++at;
            } while (at < behind);
        }
        do {
            --waiting;
        } while (as_real(SECOND_OF_ENTRY(scene, stack, waiting)) > with_slack(nearest.limit));
        uint next = FIRST_OF_ENTRY(scene, stack, waiting);
        child = params.any_hit != 0u && nearest.triangle != NO_HIT ? BVH2_END : next;
    }
}
