#pragma once

#include "core/pack/packed_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace::openmp {

/// kernels/probe.h, compiled once per math mode from probe.cpp; one result per quad.
[[nodiscard]] std::vector<std::uint32_t> probe_exact(std::span<const Quad> operations);
/// Precondition: host_has_fused_multiply().
[[nodiscard]] std::vector<std::uint32_t> probe_fast(std::span<const Quad> operations);

} // namespace tetrace::openmp
