#pragma once

#include "bench/output/row_fields.h"

namespace tetrace {

/// A row's speed compared with others: its reference under another API, the fastest BVH, Embree's single rays.
[[nodiscard]] std::vector<RowField> comparison_fields();

} // namespace tetrace
