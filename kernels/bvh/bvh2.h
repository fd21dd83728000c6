// Layout bvh2: a binary tree whose nodes hold their children's boxes; near child first.
// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, and its addendum with
// Karras, 2012: the node and the loop, first through nodes, then through a leaf's triangles.

// The bottom of the stack: a leaf that ends the loop.
#define BVH2_END 0xFFFFFFFFu

// Depth at which the ray enters a box, 0 inside, or NEVER.
KERNEL_FN real box_entry(RayFrame frame, real limit, uint x_low, uint x_high, uint y_low, uint y_high, uint z_low,
                         uint z_high)
{
    real x0 = multiply_add(as_real(x_low), frame.inverse.x, -frame.offset.x);
    real x1 = multiply_add(as_real(x_high), frame.inverse.x, -frame.offset.x);
    real y0 = multiply_add(as_real(y_low), frame.inverse.y, -frame.offset.y);
    real y1 = multiply_add(as_real(y_high), frame.inverse.y, -frame.offset.y);
    real z0 = multiply_add(as_real(z_low), frame.inverse.z, -frame.offset.z);
    real z1 = multiply_add(as_real(z_high), frame.inverse.z, -frame.offset.z);
    real near = maximum(maximum(minimum(x0, x1), minimum(y0, y1)), maximum(minimum(z0, z1), real(0.0f)));
    real far = minimum(minimum(maximum(x0, x1), maximum(y0, y1)), minimum(maximum(z0, z1), limit));
    return near <= with_slack(far) ? near : NEVER;
}

KERNEL_FN Hit trace_ray(SceneView scene, TraceParams params, Ray ray, real end)
{
    RayFrame frame = frame_of(ray);
    Nearest nearest = nothing_before(ray, end);
    STACK(stack, STACK_ENTRIES(BVH2_STACK +
                               2u)); // children with their depths; BVH2_END; an entry that is written but not kept
    SET_ENTRY(scene, stack, 0u, BVH2_END, as_bits(real(0.0f)))
    uint waiting = 1u;
    uint child = 0u;
    do {
        if ((child & BVH2_LEAF) == 0u) {
            do {
                COUNT_NODE();
                uint4 xy_a = FETCH(scene, nodes, BVH2_NODE_QUADS * child);
                uint4 xy_b = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 1u);
                uint4 z = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 2u);
                uint4 children = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 3u);
                real a = box_entry(frame, nearest.depth, xy_a.x, xy_a.y, xy_a.z, xy_a.w, z.x, z.y);
                real b = box_entry(frame, nearest.depth, xy_b.x, xy_b.y, xy_b.z, xy_b.w, z.z, z.w);
                bool b_first = b < a;
                // BVH2_LEAF alone is an empty leaf: the ray enters neither box.
                child = minimum(a, b) == NEVER ? BVH2_LEAF : b_first ? children.y : children.x;
                uint later = b_first ? children.x : children.y;
                SET_ENTRY(scene, stack, waiting, later, as_bits(maximum(a, b)))
                waiting += maximum(a, b) < NEVER ? 1u : 0u;
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
            } while (as_real(SECOND_OF_ENTRY(scene, stack, waiting)) > with_slack(nearest.depth));
            uint next = FIRST_OF_ENTRY(scene, stack, waiting);
            child = params.any_hit != 0u && nearest.triangle != NO_HIT ? BVH2_END : next;
        }
    } while (child != BVH2_END);
    return hit_of(scene, ray, nearest);
}
