#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace::vulkan {

/// SPIR-V in which values[i] replaces the specialization constant of ID i: an ordinary constant, as is all that is
/// computed from it. A driver's compiler then has no branch that depends on it: SwiftShader's takes seconds instead of
/// minutes. A constant without a value, and an operation that the kernels do not have, stays as it is.
/// module: whole words in this machine's byte order. Throws Error{internal} if an instruction has no end.
[[nodiscard]] std::vector<std::uint32_t> specialized(std::span<const std::byte> module,
                                                     std::span<const std::uint32_t> values);

} // namespace tetrace::vulkan
