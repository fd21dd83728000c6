// The body of cwbvh's loop: a node, its triangles, and which hits are next. It has the variables of trace_ray().
{
    uint bit = highest_bit(hits);
    hits ^= 1u << bit;
    uint slot = (bit & 7u) ^ octant;
    uint node = base + bit_count(hits & ((1u << slot) - 1u));
    if (hits > 0x00FFFFFFu) {
        SET_ENTRY(scene, stack, waiting, base, hits)
        ++waiting;
    }
    Visit visit = visit_of(scene, frame, nearest.limit, octant, node);
    uint triangles = visit.hits & ~CWBVH_INNER_HITS;
    while (triangles != 0u) {
        TEST_NEXT_TRIANGLE(visit.triangles)
    }
    base = visit.children;
    hits = (visit.hits & CWBVH_INNER_HITS) | visit.inner;
    if (hits <= 0x00FFFFFFu && waiting != 0u) {
        --waiting;
        base = FIRST_OF_ENTRY(scene, stack, waiting);
        hits = SECOND_OF_ENTRY(scene, stack, waiting);
    }
    if (params.any_hit != 0u && nearest.triangle != NO_HIT) hits = 0u;
}
