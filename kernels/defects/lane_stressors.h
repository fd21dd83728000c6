// Stressors of subgroups, in the words of group_stressors.h, after which it is included. Also defined by the entry
// file: Lanes, a set of lanes of a subgroup; lanes_here(), those that execute it together; and of such a set:
// votes(here, vote), those of it that vote so; has_lane(set), whether this lane is in it; lane_count(set);
// lane_rank(set), how many of it come before this lane; from_first(here, value), the first one's;
// have_common_lane(a, b). A device may split the lanes that could run together in any way: the answer is the same.

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

// Ballots in both sides of a branch, and in a loop that odd items leave after one round: the set has no lane that is
// elsewhere.
GROUP_FN(ballots_in_branches)
{
    EACH_ITEM
    {
        bool is_odd = (ITEM & 1u) == 1u;
        Lanes all = lanes_here();
        Lanes odd = votes(all, is_odd);
        Lanes even = votes(all, !is_odd);
        uint strays = 0u;
        if (is_odd) {
            Lanes here = lanes_here();
            if (have_common_lane(here, even)) strays = 1u;
        } else {
            Lanes here = lanes_here();
            if (have_common_lane(here, odd)) strays = 2u;
        }
        uint rounds = 0u;
        do {
            Lanes here = lanes_here();
            if (rounds > 0u && have_common_lane(here, odd)) strays += 4u;
            rounds += WORD(1u);
        } while (!is_odd && rounds < 4u);
        if (ITEM < ITEM_COUNT) RESULT(ITEM) = (strays * 8u + rounds) ^ (ITEM * 2654435761u);
    }
}
