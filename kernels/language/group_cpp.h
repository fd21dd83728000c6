// What kernels/defects needs beyond the kernels' language, as host C++: vectors; a group's items take turns between
// barriers, and a subgroup is one item. Include it after dialect_cpp.h. Defined by the entry file:
// LOCAL_WORDS, how many words of memory a group has. Include <atomic> and <thread> before it.
#define GROUP_FN(name)                                                                                                 \
    KERNEL_FN void name([[maybe_unused]] const uint* words, uint* results, [[maybe_unused]] uint* local_words,         \
                        [[maybe_unused]] uint item_count, [[maybe_unused]] uint group, uint group_size)
#define FAR_FN(name)                                                                                                   \
    KERNEL_FN void name([[maybe_unused]] const uint* words, uint* results, uint* large, uint item_count, uint group,   \
                        uint group_size)
#define EACH_ITEM for (uint local = 0u; local < group_size; local++)
#define BARRIER
#define FENCE std::atomic_thread_fence(std::memory_order_seq_cst);
#define PAUSE std::this_thread::yield();
#define LOCAL local
#define GROUP_SIZE group_size
#define ITEM (group * group_size + local)
#define ITEM_COUNT item_count
#define RESULT(index) results[index]
#define ADD(index, added) std::atomic_ref(results[index]).fetch_add(added)
#define FAR(index) large[index]
#define FAR_END words[FAR_END_WORD]
#define LOCAL_WORD(index) local_words[index]
#define LOCAL_ADD(index, added) std::atomic_ref(local_words[index]).fetch_add(added)

using Real4 = real __attribute__((vector_size(4 * sizeof(real))));
enum { lane_x, lane_y, lane_z, lane_w };
#define REAL4(a, b, c, d) (Real4{(a), (b), (c), (d)})
#define LANE(vector, name) (vector)[lane_##name]

using Lanes = uint;
KERNEL_FN Lanes lanes_here()
{
    return 1u;
}
KERNEL_FN Lanes votes(Lanes here, bool vote)
{
    return vote ? here : 0u;
}
KERNEL_FN bool has_lane(Lanes set)
{
    return set == 1u;
}
KERNEL_FN uint lane_count(Lanes set)
{
    return set;
}
KERNEL_FN uint lane_rank(Lanes)
{
    return 0u;
}
KERNEL_FN uint from_first(Lanes, uint value)
{
    return value;
}
KERNEL_FN bool have_common_lane(Lanes a, Lanes b)
{
    return (a & b) != 0u;
}
