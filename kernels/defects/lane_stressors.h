// Stressors of subgroups, in the words of group_stressors.h, after which it is included. Also defined by the entry
// file: Lanes, a set of lanes of a subgroup; lanes_here(), those that execute it together; and of such a set:
// votes(here, vote), those of it that vote so; has_lane(set), whether this lane is in it; lane_count(set);
// lane_rank(set), how many of it come before this lane; from_first(here, value), the first one's. A device
// may split the lanes that could run together in any way: the answer is the same.

// Jobs of several lengths for lanes: those without one take as many as they are, by one atomic sum, 64 times at most.
// They leave the loop at different times. Words of all groups: how many jobs were taken, and how many lanes have left.
GROUP_FN(jobs_of_lanes)
{
    EACH_ITEM
    {
        uint refills = ITEM < ITEM_COUNT ? 64u : 0u;
        uint job = 0u;
        uint left = 0u;
        uint value = 0u;
        for (;;) {
            if (left == 0u) {
                if (refills == 0u) break;
                refills--;
                Lanes idle = lanes_here();
                uint taken = 0u;
                if (lane_rank(idle) == 0u) taken = ADD(SHARED(0u), lane_count(idle));
                job = from_first(idle, taken) + lane_rank(idle);
                if (job >= ITEM_COUNT) {
                    ADD(SHARED(0u), 0xFFFFFFFFu); // what is no job is given back
                    break;
                }
                left = 1u + (job & (job < 4096u ? 31u : 3u));
                value = job * 2654435761u;
            }
            Lanes busy = lanes_here();
            Lanes odd = votes(busy, (value & 1u) == 1u);
            Lanes even = votes(busy, (value & 1u) == 0u);
            if (has_lane(odd))
                value = value * 3u + lane_count(busy) - lane_count(odd) - lane_count(even);
            else
                value = (value >> 1u) + WORD(left);
            left--;
            if (left == 0u) ADD(job, value + 1u);
        }
        Lanes after = lanes_here();
        if (lane_rank(after) == 0u) ADD(SHARED(1u), lane_count(after));
    }
}
