#pragma once

#include "backends/embree/accelerator.h"
#include "core/device/backend.h"

#include <span>

namespace tetrace::embree {

/// Traces given rays into hits, in order, as many at a time as the method says. For jobs that ask for any hit it uses
/// Embree's occlusion query, which does not say what was hit: SOME_HIT. rays: GIVEN_RAY_QUADS per ray, as for
/// Session::set_rays. hits: one per ray.
void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> rays,
                 std::span<Hit> hits, unsigned threads);

} // namespace tetrace::embree
