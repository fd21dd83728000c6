#pragma once

#include "backends/cuda/driver.h"

namespace tetrace::cuda_host {

/// A driver whose one device is the host: its memory is the heap, a launch runs to its end on the host's threads,
/// events read the host's steady clock. Kernels are those that the build compiled, regardless of the image that a
/// module is loaded from; they are found by the names of their entries. It refuses what the real driver refuses, with
/// the same result.
[[nodiscard]] const cuda::Driver& emulated_driver();

} // namespace tetrace::cuda_host
