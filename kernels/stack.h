// A ray's stack of entries of two words, which are written together. Macros, because kernels lack pointers. If a
// dialect or a device's compiler defines STACK_TOP, that many entries, the first, are in the work-group's memory,
// through GROUP_WORDS and GROUP_WORD of the dialect, and the others in the ray's own. Most rays need few, and an
// indexed array needs a GPU's registers or its memory. Source: Ylitie, Karras, Laine, "Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, whose stacks begin in shared memory. STACK_ENTRIES(max),
// if the program knows how many entries the rays of its scene touch; else the maximum of any scene.
#ifndef STACK_ENTRIES
#define STACK_ENTRIES(max) (max)
#endif
#ifdef STACK_TOP
GROUP_WORDS(STACK_TOP* STACK_ENTRY_WORDS)
// One array: RADV keeps arrays of up to 256 bytes in registers.
#define STACK(name, entries) uint name[(entries)*STACK_ENTRY_WORDS]
#define STACK_WORD(scene, stack, entry, word)                                                                          \
    ((entry) < STACK_TOP ? GROUP_WORD(scene, (entry)*STACK_ENTRY_WORDS + (word))                                       \
                         : stack[(entry)*STACK_ENTRY_WORDS + (word)])
#define FIRST_OF_ENTRY(scene, stack, entry) STACK_WORD(scene, stack, entry, 0u)
#define SECOND_OF_ENTRY(scene, stack, entry) STACK_WORD(scene, stack, entry, 1u)
#define SET_ENTRY(scene, stack, entry, first, second)                                                                  \
    if ((entry) < STACK_TOP) {                                                                                         \
        GROUP_WORD(scene, (entry)*STACK_ENTRY_WORDS) = (first);                                                        \
        GROUP_WORD(scene, (entry)*STACK_ENTRY_WORDS + 1u) = (second);                                                  \
    } else {                                                                                                           \
        stack[(entry)*STACK_ENTRY_WORDS] = (first);                                                                    \
        stack[(entry)*STACK_ENTRY_WORDS + 1u] = (second);                                                              \
    }
#else
// Two arrays: in one, cwbvh is 4 % slower on lavapipe.
#define STACK(name, entries)                                                                                           \
    uint name##_first[entries];                                                                                        \
    uint name##_second[entries]
#define FIRST_OF_ENTRY(scene, stack, entry) (stack##_first[entry])
#define SECOND_OF_ENTRY(scene, stack, entry) (stack##_second[entry])
#define SET_ENTRY(scene, stack, entry, first, second)                                                                  \
    stack##_first[entry] = (first);                                                                                    \
    stack##_second[entry] = (second);
#endif
