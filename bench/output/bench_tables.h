#pragma once

#include "bench/output/bench_report.h"
#include "bench/output/row_fields.h"

#include <string>

namespace tetrace {

/// What the fields of each row are read from.
[[nodiscard]] std::vector<RowFacts> facts_of(const BenchResult& result);

/// The results of a scene's rows, by device, under headings that name the hardware.
[[nodiscard]] Table rate_table(const std::string& scene, const BenchResult& result);

/// Where the time of all rows goes, in milliseconds, by scene and device.
[[nodiscard]] Table time_table(const BenchResult& result);

/// The rows' devices and their peak rates.
[[nodiscard]] Table device_table(const std::vector<RowDevice>& devices);

/// The keys of all columns of the three tables above.
[[nodiscard]] std::vector<std::string> bench_columns();

/// Every row with all its figures, flat.
[[nodiscard]] Table flat_table(const BenchResult& result);

} // namespace tetrace
