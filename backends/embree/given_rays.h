#pragma once

#include "backends/embree/accelerator.h"
#include "core/device/backend.h"

#include <span>

namespace tetrace::embree {

/// Traces rays that are given, one at a time or sixteen in their order, into hits; of jobs that ask for any hit, by
/// Embree's own query for that, which does not say what was hit: SOME_HIT.
/// rays: GIVEN_RAY_QUADS a ray, as Session::set_rays has them. hits: one a ray.
void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> rays,
                 std::span<Hit> hits, unsigned threads);

} // namespace tetrace::embree
