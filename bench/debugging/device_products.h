#pragma once

#include "core/device/backend.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace tetrace {

/// The self-test's program (Backend::probe): an operation of kernels/probe.h a quad, and its results.
using RunOperations = std::function<std::vector<std::uint32_t>(std::span<const Quad> operations)>;

/// An edge that a ray passes, from a to b.
struct PassedEdge {
    Float3 a, b;
};

/// The side of the ray at each edge, u . ((a - o) x (b - o)), with every sum and product computed by a device, one
/// operation of its self-test's program each: what the device's arithmetic makes of it, whatever a kernel does.
/// Positive, negative or 0 as in docs/spec/README.md. Throws what `run` throws.
[[nodiscard]] std::vector<float> side_products(const Float3& origin, const Float3& direction,
                                               const std::vector<PassedEdge>& edges, const RunOperations& run);

} // namespace tetrace
