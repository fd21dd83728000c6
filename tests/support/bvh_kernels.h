#pragma once

// The kernels of our BVH layouts, compiled as host C++: what they share, and a namespace for each.

#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#define KERNEL_ARRAYS_HEADER "kernels/bvh/bvh_arrays.h"

namespace tetrace::test::bvh {
namespace { // kernels of other sources have the same names

#include "kernels/language/dialect_cpp.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_cpp.h"

#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/bvh/bvh.h"

namespace bvh2 {
#include "kernels/bvh/bvh2.h"
}
#undef TRAVERSAL_ENTRIES
#undef TRAVERSAL_AT_ROOT
#undef TRAVERSAL_GOES_ON
namespace bvh4 {
#include "kernels/bvh/bvh4.h"
}
#undef TRAVERSAL_ENTRIES
#undef TRAVERSAL_AT_ROOT
#undef TRAVERSAL_GOES_ON
namespace cwbvh {
#include "kernels/bvh/cwbvh.h"
}

#include "kernels/language/view_cpp.h"

#include "kernels/language/params_cpp.h"

/// By the kernel of the packed scene's layout.
inline Hit trace_packed(const tetrace::PackedScene& packed, const TraceParams& params, Ray ray, float end)
{
    const SceneView view = view_of(packed);
    switch (packed.layout) {
    case Layout::bvh2: return bvh2::trace_ray(view, params, ray, end);
    case Layout::bvh4: return bvh4::trace_ray(view, params, ray, end);
    default: return cwbvh::trace_ray(view, params, ray, end);
    }
}

} // namespace
} // namespace tetrace::test::bvh

#undef KERNEL_ARRAYS_HEADER
