#pragma once

#include "bench/results/result_file.h"

#include <string>

namespace tetrace {

/// The scene that a row was timed on. Throws Error{invalid_input} naming file and row where the file does not have it.
[[nodiscard]] const ResultScene& scene_of(const ResultFile& file, const ResultRow& row);

/// Why two rows of equal names, of results A and B, did not do the same work: their scenes, views, sizes or hit hashes
/// differ, or on a GPU the numbers of launches; of exit searches, their number or the hash of their faces. Empty where
/// they did the same. Throws as scene_of() does.
[[nodiscard]] std::string different_work(const ResultFile& a, const ResultRow& row_a, const ResultFile& b,
                                         const ResultRow& row_b);

/// Equal texts are the same rays through the same scene, or the same searches. Throws as scene_of() does.
[[nodiscard]] std::string rays_of(const ResultFile& file, const ResultRow& row);

/// Equal texts are the same work: the same row with the same rays and the same answers. Empty for a row that has no
/// hash of its answers, whose work nobody can tell. Throws as scene_of() does.
[[nodiscard]] std::string work_of(const ResultFile& file, const ResultRow& row);

} // namespace tetrace
