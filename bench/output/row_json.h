#pragma once

#include "bench/output/row_fields.h"

namespace tetrace {

/// A row as results record it: those fields of row_fields() for which it has a value.
[[nodiscard]] nlohmann::json row_json(const RowFacts& facts);

/// A row's speed compared with its reference's. Precondition: facts.comparison.
[[nodiscard]] nlohmann::json ratio_json(const RowFacts& facts);

} // namespace tetrace
