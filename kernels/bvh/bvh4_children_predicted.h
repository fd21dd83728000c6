// Which child of a node is next, and which wait, for processors that predict it (docs/spec/devices.md, W10): each set
// of boxes that a ray may enter has a case of its own, so that the next node is read before this one's boxes are known.
// The same order as in bvh4_loop.h. It has the loop's variables, `children`, `keys` without their slots, and `entered`:
// bit i for child i.
switch (entered) {
case 0u: KEEP_BRANCH;
#ifdef HOST_SSE2
    GO_TO_WAITING
    child = FIRST_OF_ENTRY(scene, stack, waiting);
#else
    child = BVH4_LEAF; // an empty leaf: PoCL is faster so
#endif
    break;
case 1u: ENTER_CHILD(x) break;
case 2u: ENTER_CHILD(y) break;
case 4u: ENTER_CHILD(z) break;
case 8u: ENTER_CHILD(w) break;
case 3u: ENTER_NEARER_CHILD(x, y) break;
case 5u: ENTER_NEARER_CHILD(x, z) break;
case 6u: ENTER_NEARER_CHILD(y, z) break;
case 9u: ENTER_NEARER_CHILD(x, w) break;
case 10u: ENTER_NEARER_CHILD(y, w) break;
case 12u: ENTER_NEARER_CHILD(z, w) break;
case 7u:
    ENTER_NEARER_CHILD(x, y)
    ADD_CHILD(z, 1u)
    break;
case 11u:
    ENTER_NEARER_CHILD(x, y)
    ADD_CHILD(w, 1u)
    break;
case 13u:
    ENTER_NEARER_CHILD(x, z)
    ADD_CHILD(w, 1u)
    break;
case 14u:
    ENTER_NEARER_CHILD(y, z)
    ADD_CHILD(w, 1u)
    break;
default:
    ENTER_NEARER_CHILD(x, y)
    ADD_CHILD(z, 1u)
    ADD_CHILD(w, 2u)
    break;
}
