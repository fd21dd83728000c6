// The body of cwbvh's loop: a node, its triangles, and which hits are next. It has the variables of trace_ray().
{
    uint bit = highest_bit(hits);
    hits ^= 1u << bit;
    uint slot = (bit & 7u) ^ turn;
    uint node = base + bit_count(hits & ((1u << slot) - 1u));
    if (hits > 0x00FFFFFFu) {
        SET_ENTRY(scene, stack, waiting, base, hits)
        ++waiting;
    }
    COUNT_NODE();
    uint4 r0 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node);
    uint4 r1 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 1u);
    uint4 r2 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 2u);
    uint4 r3 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 3u);
    uint4 r4 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 4u);
    uint node_hits = hits_of_node(frame, nearest.depth, turn, r0, r1, r2, r3, r4);
    uint triangles = node_hits & ~CWBVH_INNER_HITS;
    while (triangles != 0u) {
        uint triangle = highest_bit(triangles);
        triangles ^= 1u << triangle;
        nearest = nearer_triangle(scene, frame, nearest, r1.y + triangle);
    }
    base = r1.x;
    hits = (node_hits & CWBVH_INNER_HITS) | r0.w >> 24u;
    if (hits <= 0x00FFFFFFu && waiting != 0u) {
        --waiting;
        base = FIRST_OF_ENTRY(scene, stack, waiting);
        hits = SECOND_OF_ENTRY(scene, stack, waiting);
    }
    if (params.any_hit != 0u && nearest.triangle != NO_HIT) hits = 0u;
}
