#pragma once

#include "bench/debugging/ray_steps.h"
#include "bench/output/report.h"

#include <memory>
#include <vector>

namespace tetrace {

/// One ray on every device.
struct TraceRun {
    std::unique_ptr<SceneWork> scene;
    std::vector<RowRun> rows;      ///< openmp's in schedule tiles first, with which the others are compared
    std::vector<RayOnDevice> rays; ///< of the rows that could trace it, in their order
    PixelRay ray;

    /// openmp's ray; null where openmp could not trace it, and nothing can be compared.
    [[nodiscard]] const RayOnDevice* reference() const;
};

/// The rows that the options select of one_kernel(), and openmp's first. Throws as run_trace() does.
[[nodiscard]] std::vector<RowKey> rows_of_ray(const Options& options);

/// Loads the scene, opens the rows that the options select of one_kernel(), and openmp's, and follows the ray on
/// each. A device that fails is an error of its row.
/// Throws Error{usage} if the kernel is not ours, or the pixel makes no such ray; what one_kernel(), select_rows()
/// and loading the scene throw.
[[nodiscard]] TraceRun run_trace(const Options& options);

/// Whether a row's ray is other than openmp's where it must be the same: in its steps, or its hit by more than its
/// device's self-test allows.
[[nodiscard]] bool differs(const RayOnDevice& ray, const RayOnDevice& reference);

/// What shown_trace() makes of the ray, and the result that `show` makes the same of.
[[nodiscard]] Report trace_report(const TraceRun& run, const Options& options);

} // namespace tetrace
