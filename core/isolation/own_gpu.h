#pragma once

#include "core/device/backend.h"

#include <vector>

namespace tetrace {

/// Decides that this process takes one GPU of each backend's, for a rank among others on its machine: of n usable ones
/// that with the number local % n, in the order of PCI addresses where all have one, which is the same under every API.
/// Call it once, before any driver is needed.
void set_own_gpu(unsigned local);

/// The backends, each with all its devices but the other ranks' GPUs: rows then have the same names in every rank. The
/// backends themselves where no GPU was decided for.
[[nodiscard]] std::vector<Backend*> with_own_gpu(const std::vector<Backend*>& backends);

} // namespace tetrace
