#pragma once

#include "bench/reproduce/search_run.h"

namespace tetrace {

/// The searches and their rows as results record them (results/README.md): all that table5 was made from.
/// Precondition: the rows' sessions are open, where they ended well.
[[nodiscard]] nlohmann::json searches_json(const SearchRun& run);

} // namespace tetrace
