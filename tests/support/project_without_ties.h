#pragma once

// Method project on layout tet96, compiled as host C++, with a mistake: ties are without a rule. A tie is then "not
// positive", whichever way the edge is asked for. For tests that must find it.

#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#undef SIDE_AT_TIE // of project_on_grids.h
#define SIDE_AT_TIE(p, q, p_is_first, product) false
#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet96.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"

namespace tetrace::test::without_ties {
namespace { // kernels of other sources have the same names
#include "kernels/kernel_cpp.h"
}
} // namespace tetrace::test::without_ties
#undef SIDE_AT_TIE
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_METHOD_HEADER
