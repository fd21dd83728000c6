#pragma once

#include "bench/row_run.h"

#include <functional>
#include <vector>

namespace tetrace {

/// Told after each image: the row, the view's index in SceneWork::views(), its hits.
using ImageSeen = std::function<void(const RowRun&, std::size_t, std::span<const Hit>)>;

/// Traces every view of a scene once with each of its rows, and judges each ray in two questions: does the device
/// return what openmp returns (kernels of structure cdt, exact mode), and is the method right (the oracle)? Rows that
/// cannot be traced end with their reason. rows: all of one scene, opened.
void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen = {});

} // namespace tetrace
