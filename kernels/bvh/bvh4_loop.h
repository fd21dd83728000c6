// The body of bvh4's loop: through nodes to a leaf, then through the leaf's triangles. It has the variables of
// trace_ray().
{
    if ((child & BVH4_LEAF) == 0u) {
        do {
            COUNT_NODE();
#ifdef BVH4_PREDICTED
            uint key;
#endif
#ifdef HOST_SSE2
#include "kernels/bvh/bvh4_node_sse2.h"
#else
            uint node = BVH4_NODE_QUADS * child;
            uint down_x = frame.inverse.x < real(0.0f) ? 1u : 0u;
            uint down_y = frame.inverse.y < real(0.0f) ? 1u : 0u;
            uint down_z = frame.inverse.z < real(0.0f) ? 1u : 0u;
            uint4 near_x = FETCH(scene, nodes, node + down_x);
            uint4 far_x = FETCH(scene, nodes, node + 1u - down_x);
            uint4 near_y = FETCH(scene, nodes, node + 2u + down_y);
            uint4 far_y = FETCH(scene, nodes, node + 3u - down_y);
            uint4 near_z = FETCH(scene, nodes, node + 4u + down_z);
            uint4 far_z = FETCH(scene, nodes, node + 5u - down_z);
            uint4 children = FETCH(scene, nodes, node + 6u);
            uint4 keys = entry_keys(frame, nearest.limit, near_x, near_y, near_z, far_x, far_y, far_z);
#ifdef BVH4_PREDICTED
            uint entered = (keys.x != BVH4_NO_KEY ? 1u : 0u) | (keys.y != BVH4_NO_KEY ? 2u : 0u) |
                           (keys.z != BVH4_NO_KEY ? 4u : 0u) | (keys.w != BVH4_NO_KEY ? 8u : 0u);
            keys &= ~3u;
#include "kernels/bvh/bvh4_children_predicted.h"
#else
            // Batcher's network for four.
            uint first_ab = lower_key(keys.x, keys.y);
            uint last_ab = higher_key(keys.x, keys.y);
            uint first_cd = lower_key(keys.z, keys.w);
            uint last_cd = higher_key(keys.z, keys.w);
            uint first = lower_key(first_ab, first_cd);
            uint last = higher_key(last_ab, last_cd);
            uint middle_a = higher_key(first_ab, first_cd);
            uint middle_b = lower_key(last_ab, last_cd);
            uint second = lower_key(middle_a, middle_b);
            uint third = higher_key(middle_a, middle_b);
            PUSH_CHILD(last)
            PUSH_CHILD(third)
            PUSH_CHILD(second)
            // BVH4_LEAF by itself is an empty leaf: the ray enters no box.
            child = first == BVH4_NO_KEY ? BVH4_LEAF : child_of(children, first);
#endif
#endif
        } while ((child & BVH4_LEAF) == 0u);
    }
    if (child != BVH4_END) {
        uint at = (child & ~BVH4_LEAF) >> 4u;
        uint behind = at + (child & 15u);
        if (at < behind) {
            do {
                nearest = nearer_triangle(scene, frame, nearest, at);
                ++at;
            } while (at < behind);
        }
        GO_TO_WAITING
        uint next = FIRST_OF_ENTRY(scene, stack, waiting);
        child = params.any_hit != 0u && nearest.triangle != NO_HIT ? BVH4_END : next;
    }
}
