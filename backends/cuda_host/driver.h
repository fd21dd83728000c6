#pragma once

#include "backends/cuda/driver.h"

namespace tetrace::cuda_host {

/// A driver whose one device is the host: its memory is the heap, a launch runs to its end on the host's threads,
/// events read the host's steady clock. A module whose image is a shared object (entries.h) has its kernels; with any
/// other image it has those that the build compiled. They are found by the names of their entries. It refuses what the
/// real driver refuses, with the same result.
[[nodiscard]] const cuda::Driver& emulated_driver();

} // namespace tetrace::cuda_host
