#pragma once

#include "core/pack/packed_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tetrace::test {

/// A ray's hit as raw words, and what the ray visited.
struct VisitedHit {
    std::array<std::uint32_t, 6> hit;
    std::uint32_t nodes, triangles;

    friend bool operator==(const VisitedHit&, const VisitedHit&) = default;
};

/// Traces one given ray through a packed BVH. quads: as Session::set_rays takes them, the direction first.
using TraceByForm = VisitedHit(const PackedScene& packed, const std::array<Quad, 2>& quads, bool any_hit);

// bvh_form_probe.cpp by layout and form: what every API compiles, what openmp's tiles and its schedule native have.
TraceByForm trace_bvh2_portable, trace_bvh2_tiles, trace_bvh2_native;
TraceByForm trace_bvh4_portable, trace_bvh4_tiles, trace_bvh4_native;
TraceByForm trace_cwbvh_portable, trace_cwbvh_tiles, trace_cwbvh_native;

} // namespace tetrace::test
