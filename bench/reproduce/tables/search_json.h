#pragma once

#include "bench/reproduce/search_run.h"

namespace tetrace {

/// The searches and their rows as results record them (results/README.md): all data behind table5.
/// Precondition: the sessions of rows without a failure are open.
[[nodiscard]] nlohmann::json searches_json(const SearchRun& run);

} // namespace tetrace
