// A node in bvh2's loop for processors, which predict which child is next (docs/spec/devices.md, W10).
{
    const Entries entries = entries_of(node_of(scene, child), frame, nearest.limit);
    const uint4& children = FETCH(scene, nodes, BVH2_NODE_QUADS * child + 3u);
    const uint first = children.x, second = children.y;
    if (entries.met == 0u) {
        KEEP_BRANCH;
        child = BVH2_LEAF; // empty
    } else if (entries.met == 1u) {
        KEEP_BRANCH;
        child = first;
    } else if (entries.met == 4u) {
        KEEP_BRANCH;
        child = second;
    } else {
        if (entries.b < entries.a) {
            KEEP_BRANCH;
            SET_ENTRY(scene, stack, waiting, first, as_bits(entries.a))
            child = second;
        } else {
            KEEP_BRANCH;
            SET_ENTRY(scene, stack, waiting, second, as_bits(entries.b))
            child = first;
        }
        ++waiting;
    }
}
