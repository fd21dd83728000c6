#pragma once

#include "bench/rows/row_run.h"

#include <cstddef>
#include <functional>
#include <span>

namespace tetrace {

/// Number of rays that the row traces of a view (an index in SceneWork::views()): one for each pixel, or the given
/// rays. There are no given rays where no primary ray of the view hits.
[[nodiscard]] std::size_t ray_count(const RowRun& row, std::size_t view);

/// Hash of a row's given rays, view after view.
[[nodiscard]] std::uint64_t hash_of_rays(const RowRun& row);

/// The pixel (y * width + x) that a ray of a view was made for.
[[nodiscard]] std::uint32_t pixel_of_ray(const RowRun& row, std::size_t view, std::size_t ray);

/// The job of a view.
[[nodiscard]] TraceJob job_of(const RowRun& row, std::size_t view);

/// The same for the row's open session. Where the session has another view's rays, gives it this view's first.
/// Throws what Session::set_rays() throws.
[[nodiscard]] TraceJob prepare_view(RowRun& row, std::size_t view);

/// The last view of which the row has rays. Precondition: there is one.
[[nodiscard]] std::size_t last_view_with_rays(const RowRun& row);

/// Traces a view and waits; returns device seconds. hits: receives ray_count() hits.
[[nodiscard]] double trace_view(RowRun& row, std::size_t view, std::span<Hit> hits);

/// Duration of a launch until the end of wait(), in seconds: of the device's kernel, and by the host's clock.
struct LaunchTimes {
    double kernel_s, wall_s;
};

/// A wall clock, in seconds from an arbitrary start.
using Clock = std::function<double()>;

/// The steady clock, starting now.
[[nodiscard]] Clock host_clock();

/// Launches a job and waits; reads nothing back. clock: the host's; tests of budgets pass their own. meanwhile: called
/// between the two, where a device of its own is at work.
[[nodiscard]] LaunchTimes timed_launch(Session& session, const TraceJob& job, const Clock& clock = host_clock(),
                                       const std::function<void()>& meanwhile = {});

} // namespace tetrace
