// Layout cwbvh: a tree with eight children per node, whose boxes are bytes on the node's own grid.
// Source: Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017;
// without the paper's exchange of work between lanes.

// A node's hits: bits 24 to 31 are inner children, visited from the highest bit down; the bits below are leaf
// triangles.
#define CWBVH_INNER_HITS 0xFF000000u

// A node as a ray meets it.
STRUCT(Visit)
{
    uint hits;
    uint inner;     // bit i: the child in slot i is inner
    uint children;  // number of the first inner child
    uint triangles; // number of the first leaf triangle
};

#ifdef HOST_SSE2
#include "kernels/bvh/cwbvh_node_sse2.h"
#else
// Depth of the node's grid: plane q of an axis is at q * step + start.
STRUCT(GridFrame)
{
    Vec3 step;
    Vec3 start;
};

KERNEL_FN GridFrame grid_frame(RayFrame frame, uint4 quad)
{
    GridFrame grid;
    PRECISE real step_x = as_real((quad.w & 0xFFu) << 23u) * frame.inverse.x;
    PRECISE real step_y = as_real((quad.w >> 8u & 0xFFu) << 23u) * frame.inverse.y;
    PRECISE real step_z = as_real((quad.w >> 16u & 0xFFu) << 23u) * frame.inverse.z;
    PRECISE real start_x = (as_real(quad.x) - frame.origin.x) * frame.inverse.x;
    PRECISE real start_y = (as_real(quad.y) - frame.origin.y) * frame.inverse.y;
    PRECISE real start_z = (as_real(quad.z) - frame.origin.z) * frame.inverse.z;
    grid.step = VEC3(step_x, step_y, step_z);
    grid.start = VEC3(start_x, start_y, start_z);
    return grid;
}

KERNEL_FN real plane_depth(real step, real start, uint planes, uint shift)
{
    return multiply_add(to_real(planes >> shift & 0xFFu), step, start);
}

// Hits of four children, whose planes are the bytes of the words. octant: the ray's octant, inverted. slot xor octant
// is a child's rank in the order of visits: the highest is visited first.
KERNEL_FN uint hits_of_four(GridFrame grid, real limit, uint octant, uint meta, uint near_x, uint near_y, uint near_z,
                            uint far_x, uint far_y, uint far_z)
{
    uint hits = 0u;
    for (uint shift = 0u; shift < 32u; shift += 8u) {
        real near = maximum(maximum(plane_depth(grid.step.x, grid.start.x, near_x, shift),
                                    plane_depth(grid.step.y, grid.start.y, near_y, shift)),
                            maximum(plane_depth(grid.step.z, grid.start.z, near_z, shift), real(0.0f)));
        real far = minimum(minimum(plane_depth(grid.step.x, grid.start.x, far_x, shift),
                                   plane_depth(grid.step.y, grid.start.y, far_y, shift)),
                           minimum(plane_depth(grid.step.z, grid.start.z, far_z, shift), limit));
        uint child = meta >> shift & 0xFFu;
        uint bit = (child & 31u) ^ ((child & 24u) == 24u ? octant : 0u);
        hits |= near <= with_slack(far) ? child >> 5u << bit : 0u;
    }
    return hits;
}

KERNEL_FN Visit visit_of(SceneView scene, RayFrame frame, real limit, uint octant, uint node)
{
    COUNT_NODE();
    uint4 r0 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node);
    uint4 r1 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 1u);
    uint4 r2 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 2u);
    uint4 r3 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 3u);
    uint4 r4 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 4u);
    GridFrame grid = grid_frame(frame, r0);
    bool down_x = frame.inverse.x < real(0.0f);
    bool down_y = frame.inverse.y < real(0.0f);
    bool down_z = frame.inverse.z < real(0.0f);
    uint first = hits_of_four(grid, limit, octant, r1.z, down_x ? r3.z : r2.x, down_y ? r4.x : r2.z,
                              down_z ? r4.z : r3.x, down_x ? r2.x : r3.z, down_y ? r2.z : r4.x, down_z ? r3.x : r4.z);
    uint last = hits_of_four(grid, limit, octant, r1.w, down_x ? r3.w : r2.y, down_y ? r4.y : r2.w,
                             down_z ? r4.w : r3.y, down_x ? r2.y : r3.w, down_y ? r2.w : r4.y, down_z ? r3.y : r4.w);
    Visit visit;
    visit.hits = first | last;
    visit.inner = r0.w >> 24u;
    visit.children = r1.x;
    visit.triangles = r1.y;
    return visit;
}

// The octant that the ray comes from: x is bit 2, y bit 1, z bit 0.
KERNEL_FN uint octant_of(RayFrame frame)
{
    return (frame.inverse.x < real(0.0f) ? 0u : 4u) | (frame.inverse.y < real(0.0f) ? 0u : 2u) |
           (frame.inverse.z < real(0.0f) ? 0u : 1u);
}
#endif

// A traversal is text, as that of bvh2.h; the loop's body is cwbvh_loop.h.
#define TRAVERSAL_ENTRIES CWBVH_STACK
// hits: at first the root; bits 0 to 7 mark the slots of a group that are inner children.
#define TRAVERSAL_AT_ROOT(type)                                                                                        \
    type octant = octant_of(frame);                                                                                    \
    type waiting = 0u;                                                                                                 \
    type base = 0u;                                                                                                    \
    type hits = 0x80000000u;
#define TRAVERSAL_GOES_ON (hits > 0x00FFFFFFu)
#ifdef LANES_VOTE
// A group of triangles may be postponed to entries below this one, so that all nodes on a path fit.
#define CWBVH_PUT_OFF 8u
#define TOGETHER_ENTRIES (CWBVH_STACK + CWBVH_PUT_OFF)
#define TOGETHER_GOES_ON (hits != 0u)
#ifndef PUTS_TRIANGLES_OFF // a test asks what it saves
#define PUTS_TRIANGLES_OFF true
#endif
#endif
#define TEST_NEXT_TRIANGLE(first)                                                                                      \
    uint triangle = highest_bit(triangles);                                                                            \
    triangles ^= 1u << triangle;                                                                                       \
    nearest = nearer_triangle(scene, frame, nearest, (first) + triangle);

KERNEL_FN Hit trace_ray(SceneView scene, TraceParams params, Ray ray, real end)
{
    RayFrame frame = frame_of(ray);
    Nearest nearest = no_hit_before(ray, end);
    STACK(stack, STACK_ENTRIES(TRAVERSAL_ENTRIES));
    TRAVERSAL_AT_ROOT(uint)
    while (TRAVERSAL_GOES_ON) {
#include "kernels/bvh/cwbvh_loop.h"
    }
    return hit_of(scene, ray_of(frame), nearest);
}
