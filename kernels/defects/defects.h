// defects/: reduced kernels of defects that drivers' compilers have; core/device/defects.h says
// what each should return, and on which drivers it was seen. Include it after a dialect header. Defined by the entry
// file: DEFECT_WORDS, the parameter that hands over the words that every kernel reads, DEFECT_PASSED, the argument for
// it, and WORD(index), which reads one.

// A value that is loaded in a loop which items leave at different times, and used after it.
KERNEL_FN uint value_after_divergent_loop(DEFECT_WORDS uint item)
{
    uint count = 0u;
    uint value;
    do {
        value = WORD(count);
        count++;
    } while (value != item && count < 64u);
    return value;
}

// A loop of more than 65,535 iterations.
KERNEL_FN uint loop_of_70000_iterations(DEFECT_WORDS uint item)
{
    uint value = WORD(item);
    for (uint i = 0u; i < 70000u; i++)
        value = value * 1664525u + 1013904223u;
    return value;
}

STRUCT(CountedWalk)
{
    uint at;
    uint steps;
    uint undecided;
};

KERNEL_FN CountedWalk next_counted(DEFECT_WORDS CountedWalk walk)
{
    CountedWalk next = walk;
    uint word = WORD(walk.at);
    next.at = (word + 11u) & 63u;
    next.steps = walk.steps + 1u;
    next.undecided = word % 7u == 0u ? 1u : 0u;
    return next;
}

// The loops of kernels/walks/walk_by_records.h: the inner one is left by a tie, which the outer one decides. The steps
// are counted in a struct that each pass replaces.
KERNEL_FN uint steps_of_nested_loops(DEFECT_WORDS uint item)
{
    uint end = 24u + 3u * item;
    CountedWalk walk;
    walk.at = item;
    walk.steps = 0u;
    walk.undecided = 0u;
    for (;;) {
        for (;;) {
            walk = next_counted(DEFECT_PASSED walk);
            if (walk.undecided == 1u || walk.steps >= end) break;
        }
        if (walk.undecided == 0u) break;
        walk.undecided = 0u;
        walk.at = (walk.at + 1u) & 63u;
        if (walk.steps >= end) break;
    }
    return walk.steps * 64u + walk.at;
}

STRUCT(Corner)
{
    real x;
    real y;
    real along;
};

STRUCT(CornerWalk)
{
    Corner p0;
    Corner p1;
    Corner p2;
    uint rotation;
    uint exit;
    uint steps;
};

KERNEL_FN uint scattered_word(DEFECT_WORDS uint index)
{
    return WORD(index & 63u) ^ (index * 2654435761u);
}

KERNEL_FN Corner corner_of(uint word)
{
    Corner corner;
    corner.x = to_real(word & 1023u) - real(500.0f);
    corner.y = to_real((word >> 10u) & 1023u) - real(499.0f);
    corner.along = to_real(word >> 20u);
    return corner;
}

KERNEL_FN bool is_walking(CornerWalk walk, uint max_steps, bool is_endless, real reach)
{
    return (walk.exit & 3u) != 3u && walk.steps < max_steps &&
           (is_endless || walk.p0.along <= reach || walk.p1.along <= reach || walk.p2.along <= reach);
}

KERNEL_FN uint replaced_corner(Corner p0, Corner p1, Corner p2, Corner apex)
{
    PRECISE real plus = p2.x * apex.y;
    PRECISE real minus = p2.y * apex.x;
    bool is_left = plus > minus;
    PRECISE real other_plus = (is_left ? p1.x : p0.x) * apex.y;
    PRECISE real other_minus = (is_left ? p1.y : p0.y) * apex.x;
    uint replaced = other_plus > other_minus ? (is_left ? 2u : 1u) : (is_left ? 0u : 2u);
    return plus == minus || other_plus == other_minus ? 3u : replaced;
}

KERNEL_FN CornerWalk with_corner(CornerWalk walk, Corner apex, uint replaced)
{
    CornerWalk next = walk;
    next.p0 = replaced == 0u ? apex : walk.p0;
    next.p1 = replaced == 1u ? apex : walk.p1;
    next.p2 = replaced == 2u ? apex : walk.p2;
    return next;
}

KERNEL_FN CornerWalk next_by_corners(DEFECT_WORDS CornerWalk walk)
{
    uint record = walk.exit >> 2u;
    Corner apex = corner_of(scattered_word(DEFECT_PASSED record));
    uint sum = walk.rotation + (walk.exit & 3u);
    uint rotation = sum >= 3u ? sum - 3u : sum;
    uint replaced = replaced_corner(walk.p0, walk.p1, walk.p2, apex);
    CornerWalk next = walk;
    next.rotation = rotation;
    next.steps = walk.steps + 1u;
    next = with_corner(next, apex, replaced);
    uint index = replaced < rotation ? replaced + 3u - rotation : replaced - rotation;
    uint word = scattered_word(DEFECT_PASSED 3u * record + index);
    uint exit = (word % 37u == 0u ? word | 3u : (word & ~3u) | ((word >> 5u) % 3u)) & 0x0FFFFFFFu;
    next.exit = replaced == 3u ? 0xFFFFFFFBu : exit;
    return next;
}

// The inner loop of kernels/walks/walk_by_records.h: a step replaces one of three structs by a select of each, and its
// number is written before; the loop goes on by the same structs.
KERNEL_FN uint steps_beside_selected_structs(DEFECT_WORDS uint item)
{
    uint max_steps = 40u + item;
    real end = to_real(1024u + 64u * item);
    bool is_endless = end >= real(3.0e38f);
    real reach = end * real(2.0f);
    CornerWalk walk;
    walk.p0 = corner_of(scattered_word(DEFECT_PASSED 4u * item));
    walk.p1 = corner_of(scattered_word(DEFECT_PASSED 4u * item + 1u));
    walk.p2 = corner_of(scattered_word(DEFECT_PASSED 4u * item + 2u));
    walk.rotation = 0u;
    walk.exit = item << 2u;
    walk.steps = 1u;
    if (is_walking(walk, max_steps, is_endless, reach)) {
        for (;;) {
            walk = next_by_corners(DEFECT_PASSED walk);
            if (!is_walking(walk, max_steps, is_endless, reach)) break;
        }
    }
    return walk.steps * 64u + item;
}

#include "kernels/defects/stressors.h"
