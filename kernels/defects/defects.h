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

#include "kernels/defects/stressors.h"
