#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"

#include <vector>

namespace tetrace {

/// Table 4: rays with a wrong result per image of 1024 x 1024, by method, scene and device, split by what went wrong.
/// It compares the paper's methods with project, which the paper does not have.
/// population: views of the camera set, of which the runs have some or all.
[[nodiscard]] PaperTable table4(const SceneRuns& runs, std::size_t population);

/// Where those rays are: their number by view, for each scene and method.
[[nodiscard]] PaperFigure table4_views(const SceneRuns& runs);

/// The rows whose numbers represent a method: for each scene and method the first that was verified, openmp's where
/// available. In exact mode every device has the same answers.
struct MethodRow {
    const SceneRun* run = nullptr;
    std::size_t row = 0; ///< index in SceneRun::rows
};
[[nodiscard]] std::vector<MethodRow> method_rows(const SceneRuns& runs);

/// Wrong and lost rays of an image.
[[nodiscard]] std::uint64_t flawed_rays(const ImageRecord& image);

} // namespace tetrace
