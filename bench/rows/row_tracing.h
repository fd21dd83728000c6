#pragma once

#include "bench/rows/row_run.h"

#include <cstddef>
#include <functional>
#include <span>

namespace tetrace {

/// Number of rays that the row traces of a view (an index in SceneWork::views()): one for each pixel, or the given
/// rays. There are no given rays if no primary ray of the view hits.
[[nodiscard]] std::size_t ray_count(const RowRun& row, std::size_t view);

/// Hash of a row's given rays, view after view.
[[nodiscard]] std::uint64_t hash_of_rays(const RowRun& row);

/// The pixel (y * width + x) that a ray of a view was made for.
[[nodiscard]] std::uint32_t pixel_of_ray(const RowRun& row, std::size_t view, std::size_t ray);

/// The job of a view.
[[nodiscard]] TraceJob job_of(const RowRun& row, std::size_t view);

/// The same for the row's open session. If the session has other views' rays, gives it this view's first.
/// Throws what Session::set_rays() throws.
[[nodiscard]] TraceJob prepare_view(RowRun& row, std::size_t view);

/// The last view of which the row has rays. Precondition: there is one.
[[nodiscard]] std::size_t last_view_with_rays(const RowRun& row);

/// Bytes that the hits of a launch may have, and so may its given rays: at most 512 MiB and the largest buffer of the
/// row's session, and of the device's memory a third, which `rows` rows share.
[[nodiscard]] std::uint64_t batch_limit(const RowRun& row, std::size_t rows);

/// The views with rays in as few batches as the limit allows; a view that exceeds it by itself is a batch.
[[nodiscard]] std::vector<ViewBatch> joined_views(const RowRun& row, std::uint64_t limit_bytes);

/// The views with rays, each in a batch of its own.
[[nodiscard]] std::vector<ViewBatch> single_views(const RowRun& row);

/// Number of rays of all views of a batch.
[[nodiscard]] std::size_t ray_count(const RowRun& row, const ViewBatch& views);

/// The jobs of a launch that traces a batch with the row's open session: one for each view, or one for all given rays,
/// view after view. Their hits are those of the views, one after the other. If the session has other views' rays,
/// gives it those of the batch first. Throws what Session::set_rays() throws.
[[nodiscard]] std::vector<TraceJob> prepare_batch(RowRun& row, const ViewBatch& views);

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

/// Launches jobs together and waits; reads nothing back. clock: the host's; tests of budgets pass their own. meanwhile:
/// called between the two, while the device is at work.
[[nodiscard]] LaunchTimes timed_launch(Session& session, std::span<const TraceJob> jobs,
                                       const Clock& clock = host_clock(), const std::function<void()>& meanwhile = {});
/// The same for one job.
[[nodiscard]] LaunchTimes timed_launch(Session& session, const TraceJob& job, const Clock& clock = host_clock(),
                                       const std::function<void()>& meanwhile = {});

} // namespace tetrace
