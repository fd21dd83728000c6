// Stressors of a large buffer, in the words of group_stressors.h, after which it is included. Also defined by the entry
// file: FAR_FN(name), the head of such a function; FAR(index), a word of that buffer, of which nothing is set; FAR_END,
// how many words it has: FAR_ROOM after a fixed boundary.

// A word of each item: among the first, or next to the boundary, on either side.
KERNEL_FN uint far_place(uint boundary, uint side, uint item)
{
    return side == 0u ? item : (side == 1u ? boundary - 1u - item : boundary + item);
}

KERNEL_FN uint far_value(uint side, uint item)
{
    return (3u * item + side + 1u) * 2654435761u;
}

// An item reads what the next one of its group wrote. An index that wraps at the boundary is that of a first word.
#define WORDS_PAST(boundary)                                                                                           \
    EACH_ITEM                                                                                                          \
    {                                                                                                                  \
        for (uint side = 0u; side < 3u; side++)                                                                        \
            FAR(far_place(boundary, side, ITEM)) = far_value(side, ITEM);                                              \
    }                                                                                                                  \
    BARRIER                                                                                                            \
    EACH_ITEM                                                                                                          \
    {                                                                                                                  \
        uint next = LOCAL + 1u == GROUP_SIZE ? ITEM - LOCAL : ITEM + 1u;                                               \
        uint sum = 0u;                                                                                                 \
        for (uint side = 0u; side < 3u; side++)                                                                        \
            sum = sum * 31u + FAR(far_place(boundary, side, next));                                                    \
        if (ITEM < ITEM_COUNT) RESULT(ITEM) = sum;                                                                     \
    }

// 24 bits of words.
FAR_FN(words_past_64_mib){WORDS_PAST(0x1000000u)}

// 31 bits of bytes.
FAR_FN(words_past_2_gib){WORDS_PAST(0x20000000u)}

// 32 bits of bytes.
FAR_FN(words_past_4_gib){WORDS_PAST(0x40000000u)}

// Of the largest buffer that the device admits: the last word is the last item's, which may have no result.
FAR_FN(words_at_the_end)
{
    WORDS_PAST(FAR_END - (ITEM_COUNT + GROUP_SIZE - 1u) / GROUP_SIZE * GROUP_SIZE)
}
