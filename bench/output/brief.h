#pragma once

#include "bench/output/bench_report.h"

namespace tetrace {

/// One screen of a run of `bench`: five rows with their scores, what is compared, whether to trust it. 24 lines of 80
/// columns, with three scenes and their primary rays.
[[nodiscard]] Sheet brief_sheet(const BenchResult& result);

/// The machine that a result was made on, and the program; a sentence. section: `tetrace` of the result.
[[nodiscard]] std::string machine_sentence(const ResultValue& section);

} // namespace tetrace
