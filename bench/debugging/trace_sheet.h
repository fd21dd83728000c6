#pragma once

#include "bench/results/result_value.h"
#include "bench/terminal/sheet.h"

namespace tetrace {

/// A trace for people, and its steps flat.
struct ShownTrace {
    Sheet sheet;
    Table table;
};

/// What `trace` prints, and `show` prints again: the ray, its answers, and its steps: a line for each step that all
/// devices take alike, else one for each way in which they take it. section: of a result of `trace`. Throws
/// Error{invalid_input} naming the key that is missing or of another kind.
[[nodiscard]] ShownTrace shown_trace(const ResultValue& section);

} // namespace tetrace
