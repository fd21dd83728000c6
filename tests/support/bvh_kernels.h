#pragma once

// The kernels of both BVH layouts, compiled as host C++: what they share, and a namespace for each.

#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#define KERNEL_ARRAYS_HEADER "kernels/bvh/bvh_arrays.h"

namespace tetrace::test::bvh {

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
namespace cwbvh {
#include "kernels/bvh/cwbvh.h"
}

#include "kernels/language/view_cpp.h"

#include "kernels/language/params_cpp.h"

} // namespace tetrace::test::bvh

#undef KERNEL_ARRAYS_HEADER
