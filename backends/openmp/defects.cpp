#include "backends/openmp/defects.h"

#include "core/base/error.h"
#include "core/device/backend.h"
#include "kernels/layouts/defect_words.h"

#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>

namespace {
#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/language/dialect_cpp.h"

#include "kernels/language/group_cpp.h"

#include "kernels/defects/defects.h"

#include "kernels/defects/group_stressors.h"

#include "kernels/defects/lane_stressors.h"

#include "kernels/defects/far_stressors.h"
} // namespace

namespace tetrace::openmp {

std::vector<std::uint32_t> words_of_defect(std::string_view name, const DefectLaunch& launch)
{
    const auto words = defect_words(launch);
    std::vector<std::uint32_t> results(output_words(name, launch));
#define DEFECT(kernel)                                                                                                 \
    if (name == #kernel) {                                                                                             \
        for (std::uint32_t item = 0; item < launch.items; ++item)                                                      \
            results[item] = kernel(words.data(), item);                                                                \
        return results;                                                                                                \
    }
#define GROUP_DEFECT(kernel)                                                                                           \
    if (name == #kernel) {                                                                                             \
        _Pragma("omp parallel for schedule(dynamic)") for (std::uint32_t group = 0; group < launch.groups(); ++group)  \
        {                                                                                                              \
            std::array<std::uint32_t, LOCAL_WORDS> local_words;                                                        \
            kernel(words.data(), results.data(), local_words.data(), launch.items, group, launch.group_items);         \
        }                                                                                                              \
        return results;                                                                                                \
    }
#define LANE_DEFECT GROUP_DEFECT
// Nothing is set in a large buffer: only what the kernel writes takes memory.
#define FAR_DEFECT(kernel)                                                                                             \
    if (name == #kernel) {                                                                                             \
        const auto large = std::make_unique_for_overwrite<std::uint32_t[]>(launch.large_words);                        \
        for (std::uint32_t group = 0; group < launch.groups(); ++group)                                                \
            kernel(words.data(), results.data(), large.get(), launch.items, group, launch.group_items);                \
        return results;                                                                                                \
    }
#include "kernels/defects/defect_list.inc"
    throw Error(ErrorKind::internal, "openmp lacks the reduced kernel '" + std::string(name) + "'");
}

} // namespace tetrace::openmp
