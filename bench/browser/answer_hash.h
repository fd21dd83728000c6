#pragma once

#include "core/rays/hit.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// What a page needs to judge a view's answers without having them.
struct AnswerHashes {
    std::array<std::uint32_t, 2> view = {}; ///< of all words of all rays, in order
    std::vector<std::uint8_t> rays;         ///< a byte each, to find the first that differs
};

/// The same bits as hash_of_words() of backends/webgpu/page.js.
[[nodiscard]] std::array<std::uint32_t, 2> hash_of_words(std::span<const std::uint32_t> words);

/// The same bits as hashes_of() of backends/webgpu/page.js.
[[nodiscard]] AnswerHashes answer_hashes(std::span<const Hit> hits);

} // namespace tetrace
