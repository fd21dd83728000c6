#pragma once

// Method maria on layout tet96, compiled as host C++.

#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet96.h"
#define KERNEL_METHOD_HEADER "kernels/methods/maria.h"

namespace tetrace::test::maria {
namespace { // kernels of other sources have the same names
#include "kernels/kernel_cpp.h"
}
} // namespace tetrace::test::maria
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_METHOD_HEADER
