// A stressor of a faulty text, or that a compiler may change: CMakeLists.txt gives FAULT, its number; TEXT; and its
// name as DEFECT or GROUP_DEFECT.
#include "tests/backends/faulty_stressor.h"

namespace {
#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/language/dialect_cpp.h"

#include "kernels/language/group_cpp.h"

// The words of a large buffer that are used. An index that is outside is that of its last word.
#undef FAR_FN
#undef FAR
#define FAR_FN(name)                                                                                                   \
    KERNEL_FN void name([[maybe_unused]] const uint* words, uint* results, std::unordered_map<uint, uint>& large,      \
                        uint item_count, uint group, uint group_size)
#define FAR(index) large[std::min(index, words[FAR_END_WORD] - 1u)]

// What a device that flushes denormals returns.
KERNEL_FN uint flushed_bits(real value)
{
    return std::fpclassify(value) == FP_SUBNORMAL ? as_bits(value) & 0x80000000u : as_bits(value);
}
#ifdef FLUSHES
#define as_bits flushed_bits
#endif
#include TEXT
} // namespace

namespace tetrace::faults {

std::vector<std::uint32_t> FAULT(const DefectLaunch& launch)
{
#ifdef GROUP_DEFECT
#define TEXT_OF(name) #name
#define NAME_OF(name) TEXT_OF(name)
    const Defect& defect = *find_defect(NAME_OF(GROUP_DEFECT));
    const auto words = defect_words({launch.items, launch.group_items, defect.large_words});
    std::vector<std::uint32_t> results(output_words(defect.name, launch));
#ifdef LARGE
    std::unordered_map<uint, uint> large;
    for (std::uint32_t group = 0; group < launch.groups(); ++group)
        GROUP_DEFECT(words.data(), results.data(), large, launch.items, group, launch.group_items);
#else
    std::array<std::uint32_t, LOCAL_WORDS> memory;
    for (std::uint32_t group = 0; group < launch.groups(); ++group)
        GROUP_DEFECT(words.data(), results.data(), memory.data(), launch.items, group, launch.group_items);
#endif
#else
    const auto words = defect_words(launch);
    std::vector<std::uint32_t> results;
    for (std::uint32_t item = 0; item < launch.items; ++item)
        results.push_back(DEFECT(words.data(), item));
#endif
    return results;
}

} // namespace tetrace::faults
