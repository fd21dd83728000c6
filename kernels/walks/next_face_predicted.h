// next_face() of walk_by_records.h for processors: what a branch decides is predicted, so the next record is loaded
// before it is known; a select would wait for it (docs/spec/devices.md, W10).

#ifdef HOST_SSE2
#include "kernels/walks/prefetch_sse2.h"
#endif

// replaced: constant, so that what depends on it is, too.
KERNEL_FN Walker walker_replacing(MAYBE_UNUSED SceneView scene, RecordExits exits, Walker at, Carried apex,
                                  uint replaced)
{
    Walker next = with_apex(at, apex, replaced);
    next.exit = EXIT_REPLACING(scene, exits, at.rotation, replaced);
    return next;
}

// Decides as roughly_replaced_by() does.
KERNEL_FN Walker next_face(SceneView scene, Ray ray, Shear shear, Walker at)
{
    uint record = record_across(at.exit);
    Carried apex = carried(ray, shear, record_apex(scene, record));
    RecordExits exits = RECORD_EXITS(scene, record);
#ifdef HOST_SSE2
    prefetch_next(scene, record, exits);
#endif
    Walker next = at;
    next.rotation = rotation_at(at.rotation, at.exit);
    next.before = at.exit;
    next.exit = EXIT_AT_TIE;
    next.steps = at.steps + 1u;
    PRECISE real plus = at.p2.seen.x * apex.seen.y;
    PRECISE real minus = at.p2.seen.y * apex.seen.x;
    if (plus > minus) {
        KEEP_BRANCH;
        PRECISE real other_plus = at.p1.seen.x * apex.seen.y;
        PRECISE real other_minus = at.p1.seen.y * apex.seen.x;
        if (other_plus > other_minus) {
            KEEP_BRANCH;
            return walker_replacing(scene, exits, next, apex, 2u);
        }
        if (other_plus < other_minus) {
            KEEP_BRANCH;
            return walker_replacing(scene, exits, next, apex, 0u);
        }
    } else if (plus < minus) {
        KEEP_BRANCH;
        PRECISE real other_plus = at.p0.seen.x * apex.seen.y;
        PRECISE real other_minus = at.p0.seen.y * apex.seen.x;
        if (other_plus > other_minus) {
            KEEP_BRANCH;
            return walker_replacing(scene, exits, next, apex, 1u);
        }
        if (other_plus < other_minus) {
            KEEP_BRANCH;
            return walker_replacing(scene, exits, next, apex, 2u);
        }
    }
    return next;
}
