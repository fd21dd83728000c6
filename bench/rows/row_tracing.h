#pragma once

#include "bench/rows/row_run.h"

#include <cstddef>
#include <functional>
#include <span>

namespace tetrace {

/// How many rays the row traces of a view (an index in SceneWork::views()): a ray a pixel, or those that are given,
/// which are none where no primary ray of the view hits.
[[nodiscard]] std::size_t ray_count(const RowRun& row, std::size_t view);

/// Of the rays that a row is given, view after view.
[[nodiscard]] std::uint64_t hash_of_rays(const RowRun& row);

/// The pixel (y * width + x) that a ray of a view was made for.
[[nodiscard]] std::uint32_t pixel_of_ray(const RowRun& row, std::size_t view, std::size_t ray);

/// The job of a view.
[[nodiscard]] TraceJob job_of(const RowRun& row, std::size_t view);

/// The same, for the row's open session; gives it the view's rays first, where it has others.
/// Throws what Session::set_rays() throws.
[[nodiscard]] TraceJob prepare_view(RowRun& row, std::size_t view);

/// Traces a view and waits; returns device seconds. hits: ray_count() of them are read back.
[[nodiscard]] double trace_view(RowRun& row, std::size_t view, std::span<Hit> hits);

/// What a launch took until the end of wait(): seconds of the device's kernel, and of the host's clock.
struct LaunchTimes {
    double kernel_s, wall_s;
};

/// A wall clock, in seconds from some start.
using Clock = std::function<double()>;

/// The steady clock, from now on.
[[nodiscard]] Clock host_clock();

/// Launches a job and waits; nothing is read back. clock: the host's; tests of budgets bring their own.
[[nodiscard]] LaunchTimes timed_launch(Session& session, const TraceJob& job, const Clock& clock = host_clock());

} // namespace tetrace
