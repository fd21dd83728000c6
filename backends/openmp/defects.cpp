#include "backends/openmp/defects.h"

#include "core/base/error.h"
#include "core/debugging/defects.h"
#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>

namespace {
#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/language/dialect_cpp.h"

#include "kernels/defects/defects.h"
} // namespace

namespace tetrace::openmp {

std::vector<std::uint32_t> run_defect(std::string_view name)
{
    const auto words = defect_words();
    std::vector<std::uint32_t> results(defect_items);
#define DEFECT(kernel)                                                                                                 \
    if (name == #kernel) {                                                                                             \
        for (std::uint32_t item = 0; item < defect_items; ++item)                                                      \
            results[item] = kernel(words.data(), item);                                                                \
        return results;                                                                                                \
    }
#include "kernels/defects/defect_list.inc"
    throw Error(ErrorKind::internal, "openmp lacks the reduced kernel '" + std::string(name) + "'");
}

} // namespace tetrace::openmp
