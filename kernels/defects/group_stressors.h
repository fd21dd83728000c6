// Stressors of work groups, whose items share memory. core/device/group_stressors.cpp has the answers, and names the
// public reports of each kind. Defined by the entry file, after a dialect header:
// GROUP_FN(name), the head of such a function; EACH_ITEM, before what each item of the group does, a loop on a
// processor; BARRIER, after it; LOCAL, GROUP_SIZE, ITEM and ITEM_COUNT: the item's number in its group, the items of a
// group, the item's number in the launch, and those that have a result.
// RESULT(index), ADD(index, added): a word of the output, and an atomic sum that returns the word before. The items'
// words come first, then those of all groups. They begin as zeros.
// LOCAL_WORD(index), LOCAL_ADD(index, added): the same of the group's memory, LOCAL_WORDS words.
// FENCE: what was written before it is seen by whoever sees an ADD after it. PAUSE, in a loop that waits: others may
// run.

// A word that all groups share.
#define SHARED(index) (ITEM_COUNT + (index))

// A barrier in a loop whose rounds are each item's own: while any item has one, those that have queue up, and other
// items do their work. Local words: the queue's length, the queue, a sum of each item.
KERNEL_FN uint own_rounds(uint item)
{
    return ((item * 2654435761u) >> 12u) % (item < 4096u ? 13u : 3u);
}

GROUP_FN(barriers_by_vote)
{
    EACH_ITEM
    {
        LOCAL_WORD(1u + GROUP_SIZE + LOCAL) = ITEM;
    }
    for (uint round = 0u;; round++) {
        EACH_ITEM
        {
            if (LOCAL == 0u) LOCAL_WORD(0u) = 0u;
        }
        BARRIER
        EACH_ITEM
        {
            if (round < own_rounds(ITEM)) LOCAL_WORD(1u + LOCAL_ADD(0u, 1u)) = LOCAL;
        }
        BARRIER
        uint queued = LOCAL_WORD(0u);
        if (queued == 0u) break;
        EACH_ITEM
        {
            if (LOCAL < queued) {
                uint place = 1u + GROUP_SIZE + LOCAL_WORD(1u + LOCAL);
                LOCAL_WORD(place) = LOCAL_WORD(place) * 31u + WORD(round) + queued;
            }
        }
        BARRIER
    }
    EACH_ITEM
    {
        if (ITEM < ITEM_COUNT) RESULT(ITEM) = LOCAL_WORD(1u + GROUP_SIZE + LOCAL);
    }
}

// Sums of 64 bits by two atomic ones of 32. The first word's value before decides the carry.
#define TALLY(SUM, index, low, high)                                                                                   \
    {                                                                                                                  \
        uint before = SUM(index, low);                                                                                 \
        uint carry = before + (low) < before ? 1u : 0u;                                                                \
        SUM((index) + 1u, (high) + carry);                                                                             \
    }

KERNEL_FN uint low_part(uint item)
{
    return (item * 2654435761u) | 0x80000000u;
}

// Of the group: one cell, then 32.
GROUP_FN(tallies_in_group)
{
    EACH_ITEM
    {
        for (uint place = LOCAL; place < 66u; place += GROUP_SIZE)
            LOCAL_WORD(place) = 0u;
    }
    BARRIER
    EACH_ITEM{TALLY(LOCAL_ADD, 0u, low_part(ITEM), ITEM & 3u)
                  TALLY(LOCAL_ADD, 2u + 2u * (ITEM & 31u), low_part(ITEM), ITEM & 3u)} BARRIER EACH_ITEM
    {
        uint cell = 2u + 2u * ((ITEM + 1u) & 31u);
        uint all = LOCAL_WORD(0u) + LOCAL_WORD(1u) * 31u;
        uint some = LOCAL_WORD(cell) + LOCAL_WORD(cell + 1u) * 31u;
        if (ITEM < ITEM_COUNT) RESULT(ITEM) = (all * 31u + some) ^ (ITEM * 2654435761u);
    }
}

// Of all groups: one cell, then 32, then 100,000.
GROUP_FN(tallies_in_buffer)
{
    EACH_ITEM
    {
        if (ITEM < ITEM_COUNT) {
            TALLY(ADD, SHARED(0u), low_part(ITEM), ITEM & 3u)
            TALLY(ADD, SHARED(2u + 2u * (ITEM & 31u)), low_part(ITEM), ITEM & 3u)
            TALLY(ADD, SHARED(66u + 2u * (ITEM * 7919u % 100000u)), low_part(ITEM), ITEM & 3u)
            RESULT(ITEM) = ~ITEM;
        }
    }
}

// Groups take tickets. Each waits for the flag of the ticket before it, which a running group has, reads what that
// group wrote, writes its own words, and sets its flag: 1, or 2 if it has waited in vain. Words of all groups: the next
// ticket, then a flag of each.
GROUP_FN(handed_over)
{
    EACH_ITEM
    {
        if (LOCAL == 0u) {
            uint taken = ADD(SHARED(0u), 1u);
            uint seen = taken == 0u ? 1u : 0u;
            for (uint polls = 0u; seen == 0u && polls < 16777216u; polls++) {
                PAUSE
                seen = ADD(SHARED(taken), 0u);
            }
            FENCE
            LOCAL_WORD(0u) = taken;
            LOCAL_WORD(1u) = seen;
        }
    }
    BARRIER
    uint ticket = LOCAL_WORD(0u);
    uint flag = LOCAL_WORD(1u);
    EACH_ITEM
    {
        uint place = ticket * GROUP_SIZE + LOCAL;
        uint next = LOCAL + 1u == GROUP_SIZE ? 0u : LOCAL + 1u;
        uint word = place + 1u;
        if (ticket > 0u) word += RESULT((ticket - 1u) * GROUP_SIZE + next) * 31u;
        if (place < ITEM_COUNT) RESULT(place) = flag == 1u ? word : 0u;
        FENCE
    }
    BARRIER
    EACH_ITEM
    {
        if (LOCAL == 0u) ADD(SHARED(1u + ticket), flag == 1u ? 1u : 2u);
    }
}
