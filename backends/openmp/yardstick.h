#pragma once

#include "core/device/backend.h"

namespace tetrace::openmp {

/// Copy bandwidth of the host's memory, the best of a few copies of 128 MiB by that many threads, and the time of an
/// empty parallel region. The processor's extra reads before writes (read for ownership) are not counted, as in STREAM.
/// Source: McCalpin, STREAM (1995), kernel Copy.
[[nodiscard]] Yardstick measure_host(unsigned threads);

} // namespace tetrace::openmp
