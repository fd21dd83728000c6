#pragma once

#include "bench/measuring/measure.h"
#include "bench/measuring/row_devices.h"
#include "bench/results/result_file.h"

namespace tetrace {

/// The rows of a result of `bench`, `check` or `reproduce`. Throws Error{invalid_input} naming the file and the key if
/// this tetrace lacks the row, or if the row lacks what its status needs.
[[nodiscard]] std::vector<RowRecord> read_rows(const ResultFile& file);

/// The rows of searches of a result of `reproduce`, in the same way, but without their answers: batches have those.
[[nodiscard]] std::vector<RowRecord> read_search_rows(const ResultFile& file);

/// The devices of a result, for these rows of it. Results of schema version 1 and those of `check` have none: then they
/// are the rows' own.
[[nodiscard]] std::vector<RowDevice> read_devices(const ResultFile& file, const std::vector<RowRecord>& rows);

/// How a result of `bench` was measured. Throws Error{invalid_input} naming the key.
[[nodiscard]] Measurement read_measurement(const ResultValue& section);
/// A count, or 1,000,000 if it is larger.
[[nodiscard]] unsigned small_count(const ResultValue& value);

} // namespace tetrace
