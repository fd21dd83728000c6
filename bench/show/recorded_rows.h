#pragma once

#include "bench/measuring/row_devices.h"
#include "bench/results/result_file.h"

namespace tetrace {

/// The rows of a result of `bench` or `check`, as far as its tables need them, so that they are made by what made them
/// in the run itself. The rows have neither scene nor packed form; their sessions know what setting up took, and launch
/// nothing. Throws Error{invalid_input} naming the file and the key where a row is none of this tetrace's, or lacks
/// what its status needs.
[[nodiscard]] std::vector<RowRun> read_rows(const ResultFile& file);

/// The rows of searches of a result of `reproduce`, in the same way, but without their answers: batches have those.
[[nodiscard]] std::vector<RowRun> read_search_rows(const ResultFile& file);

/// The devices of a result, for these rows of it. Results of schema version 1 and those of `check` have none: then they
/// are the rows' own.
[[nodiscard]] std::vector<RowDevice> read_devices(const ResultFile& file, const std::vector<RowRun>& rows);

} // namespace tetrace
