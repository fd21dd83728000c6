// A stressor of a faulty text, or that a compiler may change: CMakeLists.txt gives FAULT, its number; STRESSOR and
// TEXT.
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {
#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/language/dialect_cpp.h"

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

std::vector<std::uint32_t> FAULT(std::uint32_t items)
{
    const auto words = defect_words();
    std::vector<std::uint32_t> results;
    for (std::uint32_t item = 0; item < items; ++item)
        results.push_back(STRESSOR(words.data(), item));
    return results;
}

} // namespace tetrace::faults
