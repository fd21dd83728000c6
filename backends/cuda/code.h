#pragma once

#include "backends/cuda/device.h"

#include <optional>

namespace tetrace::cuda {

/// As Backend::compiled() describes it: the function's attributes, under the names of CUfunction_attribute, and how
/// many of its blocks and warps a multiprocessor holds. facts: of the device.
[[nodiscard]] CompiledCode compiled_code(const Driver& driver, Ordinal ordinal, const Device& facts,
                                         const Programs& programs, const std::optional<KernelId>& kernel,
                                         bool starts_outside);

} // namespace tetrace::cuda
