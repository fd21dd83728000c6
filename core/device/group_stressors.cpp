#include "core/device/stressors.h"
#include "kernels/layouts/defect_words.h"

#include <algorithm>
#include <array>

namespace tetrace {

namespace {

// What each kernel returns, by other means: item by item and in 64 bits.

using Output = std::vector<std::uint32_t>;

std::uint32_t spread(std::uint32_t item)
{
    return item * 2654435761u;
}

std::uint32_t rounds_of(std::uint32_t item)
{
    return spread(item) / 4096 % (item < 4096 ? 13 : 3);
}

Output barriers_by_vote(const DefectLaunch& launch)
{
    Output words(launch.items);
    for (std::uint32_t first = 0; first < launch.items; first += launch.group_items) {
        std::array<std::uint32_t, 13> queued{}; // in each round
        for (std::uint32_t item = first; item < first + launch.group_items; ++item)
            for (std::uint32_t round = 0; round < rounds_of(item); ++round)
                ++queued[round];
        for (std::uint32_t item = first; item < std::min(first + launch.group_items, launch.items); ++item) {
            words[item] = item;
            for (std::uint32_t round = 0; round < rounds_of(item); ++round)
                words[item] = words[item] * 31 + round + queued[round];
        }
    }
    return words;
}

std::uint64_t tallied(std::uint32_t item)
{
    return std::uint64_t{item % 4} << 32 | spread(item) | 0x80000000;
}

std::uint32_t folded(std::uint64_t sum)
{
    return static_cast<std::uint32_t>(sum) + static_cast<std::uint32_t>(sum >> 32) * 31;
}

/// The last group has all its items.
Output tallies_in_group(const DefectLaunch& launch)
{
    Output words(launch.items);
    for (std::uint32_t first = 0; first < launch.items; first += launch.group_items) {
        std::uint64_t all = 0;
        std::array<std::uint64_t, 32> some{};
        for (std::uint32_t item = first; item < first + launch.group_items; ++item) {
            all += tallied(item);
            some[item % 32] += tallied(item);
        }
        for (std::uint32_t item = first; item < std::min(first + launch.group_items, launch.items); ++item)
            words[item] = (folded(all) * 31 + folded(some[(item + 1) % 32])) ^ spread(item);
    }
    return words;
}

constexpr std::uint32_t many_cells = 100'000;
constexpr std::uint32_t tally_words = 2 * (1 + 32 + many_cells);

Output tallies_in_buffer(const DefectLaunch& launch)
{
    std::vector<std::uint64_t> cells(tally_words / 2);
    Output words(launch.items);
    for (std::uint32_t item = 0; item < launch.items; ++item) {
        words[item] = ~item;
        for (const std::uint32_t cell : {0u, 1 + item % 32, 33 + item * 7919 % many_cells})
            cells[cell] += tallied(item);
    }
    for (const std::uint64_t cell : cells) {
        words.push_back(static_cast<std::uint32_t>(cell));
        words.push_back(static_cast<std::uint32_t>(cell >> 32));
    }
    return words;
}

constexpr std::uint32_t hand_over_words = 1 + 65'535; ///< the next ticket, and a flag of each group that there may be

Output handed_over(const DefectLaunch& launch)
{
    const std::uint32_t width = launch.group_items;
    Output words(launch.items + hand_over_words);
    for (std::uint32_t first = 0; first < launch.items; first += width)
        for (std::uint32_t local = 0; local < std::min(width, launch.items - first); ++local) {
            const std::uint32_t next = local + 1 == width ? 0 : local + 1;
            words[first + local] = first + local + 1 + (first == 0 ? 0 : words[first - width + next] * 31);
        }
    words[launch.items] = launch.groups();
    std::fill_n(words.begin() + launch.items + 1, launch.groups(), 1);
    return words;
}

Output jobs_of_lanes(const DefectLaunch& launch)
{
    Output words(launch.items);
    for (std::uint32_t job = 0; job < launch.items; ++job) {
        std::uint32_t value = spread(job);
        for (std::uint32_t left = job % (job < 4096 ? 32 : 4) + 1; left > 0; --left)
            value = value % 2 == 1 ? value * 3 : value / 2 + left;
        words[job] = value + 1;
    }
    words.push_back(launch.items);
    words.push_back(launch.groups() * launch.group_items);
    return words;
}

Output ballots_in_branches(const DefectLaunch& launch)
{
    Output words(launch.items);
    for (std::uint32_t item = 0; item < launch.items; ++item)
        words[item] = (item % 2 == 1 ? 1 : 4) ^ spread(item);
    return words;
}

std::uint32_t far_value(std::uint32_t side, std::uint32_t item)
{
    return spread(3 * item + side + 1);
}

/// The same for every boundary.
Output words_past(const DefectLaunch& launch)
{
    Output words(launch.items);
    for (std::uint32_t item = 0; item < launch.items; ++item) {
        const std::uint32_t local = item % launch.group_items;
        const std::uint32_t next = item - local + (local + 1) % launch.group_items;
        words[item] = (far_value(0, next) * 31 + far_value(1, next)) * 31 + far_value(2, next);
    }
    return words;
}

/// bytes: the boundary; of the largest buffer, the size of a case, which Vulkan and OpenCL guarantee.
constexpr Defect words_past_boundary(std::string_view name, std::string_view what, std::uint64_t bytes,
                                     DefectNeed need = DefectNeed::large_buffer)
{
    return {.name = name,
            .what = what,
            .known = "wgpu#2361, wgpu#10305",
            .expected = nullptr,
            .is_stressor = true,
            .expected_output = words_past,
            .need = need,
            .large_words = static_cast<std::uint32_t>(bytes / sizeof(std::uint32_t)) +
                           (need == DefectNeed::large_buffer ? FAR_ROOM : 0)};
}

} // namespace

std::span<const Defect> group_stressors()
{
    static constexpr Defect stressors[] = {
        {.name = "barriers_by_vote",
         .what = "barriers in a loop of each item's own number of rounds, which ends when a queue in the group's "
                 "memory is empty",
         .known = "pocl#1167, pocl#1747, pocl#1794",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = barriers_by_vote},
        {.name = "tallies_in_group",
         .what = "64-bit sums by two atomic ones with a carry, in the group's memory",
         .known = "mcxcl#63, ROCm/hip#2260",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = tallies_in_group},
        {.name = "tallies_in_buffer",
         .what = "64-bit sums by two atomic ones with a carry, in 1, 32 and 100,000 cells of a buffer",
         .known = "mcxcl#63, ROCm/hip#2260",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = tallies_in_buffer,
         .shared_words = tally_words},
        {.name = "handed_over",
         .what = "groups that take tickets, wait for the flag of the one before, and read what it wrote",
         .known = "GPUHarbor (ISSTA 2023)",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = handed_over,
         .shared_words = hand_over_words,
         .need = DefectNeed::fences},
        {.name = "jobs_of_lanes",
         .what =
             "ballots, ranks and broadcasts of subgroups in a loop that lanes leave at different times, and after it",
         .known = "IGC#396, IGC#402, offload-test-suite#533, offload-test-suite#688, offload-test-suite#1293",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = jobs_of_lanes,
         .shared_words = 2,
         .need = DefectNeed::ballots},
        {.name = "ballots_in_branches",
         .what = "ballots of subgroups in both sides of a branch, and in a loop that lanes leave at different times",
         .known = "IGC#396, offload-test-suite#533",
         .expected = nullptr,
         .is_stressor = true,
         .expected_output = ballots_in_branches,
         .need = DefectNeed::ballots},
        words_past_boundary("words_past_64_mib", "words of a buffer before and after byte 2^26, word 2^24",
                            std::uint64_t{1} << 26),
        words_past_boundary("words_past_2_gib", "words of a buffer before and after byte 2^31", std::uint64_t{1} << 31),
        words_past_boundary("words_past_4_gib", "words of a buffer before and after byte 2^32", std::uint64_t{1} << 32),
        words_past_boundary("words_at_the_end", "the first and the last words of the largest buffer that is admitted",
                            std::uint64_t{1} << 27, DefectNeed::largest_buffer),
    };
    return stressors;
}

} // namespace tetrace
