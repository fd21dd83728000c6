#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tetrace {

/// A defect of a driver's compiler, reduced to a small kernel (kernels/defects/defects.h, in every language). The
/// kernel is one work group of defect_items items; each returns a word.
struct Defect {
    std::string_view name;  ///< of its kernel
    std::string_view what;  ///< what the kernel does
    std::string_view known; ///< where the defect was met
    std::uint32_t (*expected)(std::uint32_t item);
};
inline constexpr std::uint32_t defect_items = 16;

/// Every reduced kernel, in the order of kernels/defects/defect_list.inc.
[[nodiscard]] std::span<const Defect> all_defects();

/// The words that every kernel reads: 0, 1, ... 63.
[[nodiscard]] std::vector<std::uint32_t> defect_words();

/// The items whose word is not the expected one; all of them where the number of words is not defect_items.
[[nodiscard]] std::vector<std::uint32_t> wrong_items(const Defect& defect, std::span<const std::uint32_t> words);

} // namespace tetrace
