// The body of cwbvh's loop where a warp's lanes go through it together (refill_cuda.h): a node, or a group of triangles
// that was put off; then triangles, for as long as enough lanes have one. Else the lanes put theirs off, and go on with
// nodes until more have some. It has the variables of trace_refilled(); going: the lanes that are here.
// Source: Ylitie, Karras, Laine, HPG 2017, which calls this triangle postponing, and keeps such groups on the stack
// too.
{
    uint triangles = hits; // of a group that was put off
    uint first = base;
    if (hits > 0x00FFFFFFu) {
        uint bit = highest_bit(hits);
        hits ^= 1u << bit;
        uint slot = (bit & 7u) ^ octant;
        uint node = base + bit_count(hits & ((1u << slot) - 1u));
        if (hits > 0x00FFFFFFu) {
            SET_ENTRY(scene, stack, waiting, base, hits)
            ++waiting;
        }
        Visit visit = visit_of(scene, frame, nearest.limit, octant, node);
        triangles = visit.hits & ~CWBVH_INNER_HITS;
        first = visit.triangles;
        base = visit.children;
        hits = (visit.hits & CWBVH_INNER_HITS) | visit.inner;
    }
    if (hits <= 0x00FFFFFFu) hits = 0u;
    // Any hit is the first one found, which depends on the order of the tests; the nearest one does not.
    uint enough = PUTS_TRIANGLES_OFF && params.any_hit == 0u ? (bit_count(going) + 4u) / 5u : 1u;
    for (;;) {
        if (bit_count(__ballot_sync(going, triangles != 0u)) < enough) break;
        if (triangles != 0u) {
            TEST_NEXT_TRIANGLE(first)
        }
    }
    // A lane without nodes waits with its triangles.
    if (hits != 0u) {
        while (waiting >= CWBVH_PUT_OFF && triangles != 0u) {
            TEST_NEXT_TRIANGLE(first)
        }
        if (triangles != 0u) {
            SET_ENTRY(scene, stack, waiting, first, triangles)
            ++waiting;
        }
    } else if (triangles != 0u) {
        base = first;
        hits = triangles;
    } else if (waiting != 0u) {
        --waiting;
        base = FIRST_OF_ENTRY(scene, stack, waiting);
        hits = SECOND_OF_ENTRY(scene, stack, waiting);
    }
    if (params.any_hit != 0u && nearest.triangle != NO_HIT) hits = 0u;
}
