#pragma once

#include "bench/measuring/row_devices.h"
#include "bench/reproduce/search_run.h"
#include "bench/reproduce/tables/paper_table.h"

namespace tetrace {

/// Table 5: the exit search alone, by method, layout and device: rates, and the number of faces that are not the exact
/// ones.
/// devices: those that the rows ran on, measured.
[[nodiscard]] PaperTable table5(const SearchRun& run, const std::vector<RowDevice>& devices);

/// Bytes that a search moves besides its tet, which stays in the caches for all of its rays: 32 of the ray's 48,
/// because no method needs both its origin and its moment, and the face that it writes.
inline constexpr double bytes_per_search = 32 + 4;

} // namespace tetrace
