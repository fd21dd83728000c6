// A BVH's traversal in one of its forms, with visits counted, for bvh_form_test.cpp: compiled once for each layout and
// form, as openmp compiles them.
#include "tests/kernels/bvh_form_probe.h"
#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#if defined(FOR_PROCESSORS) && defined(__SSE2__)
#include <immintrin.h>
#define HOST_SSE2
#endif

namespace {
std::uint32_t visited_nodes, visited_triangles;
#define COUNT_NODE() (visited_nodes++)
#define COUNT_TRIANGLE() (visited_triangles++)
#include "kernels/kernel_cpp.h"
} // namespace

namespace tetrace::test {

VisitedHit KERNEL_NAME(const PackedScene& packed, const std::array<Quad, 2>& quads, bool any_hit)
{
    visited_nodes = visited_triangles = 0;
    ::TraceParams params{};
    params.any_hit = any_hit ? 1 : 0;
    const ::Hit hit = trace_given(view_of(packed), params, quads[0], quads[1]);
    return {std::bit_cast<std::array<std::uint32_t, 6>>(hit), visited_nodes, visited_triangles};
}

} // namespace tetrace::test
