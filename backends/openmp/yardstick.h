#pragma once

#include "core/device/backend.h"

namespace tetrace::openmp {

/// Copy bandwidth of the host's memory, the best of a few copies of 128 MiB by that many threads, and the time of an
/// empty parallel region. The processor's extra reads before writes (read for ownership) are not counted, as in STREAM.
/// Source: McCalpin, STREAM (1995), kernel Copy.
[[nodiscard]] Yardstick measure_host(unsigned threads);

/// Seconds of a fixed short piece of work by that many threads at once, some milliseconds: each follows a chain of
/// reads through a table in the far caches, and multiplies as it goes. The work is the same in every build and every
/// run, so only the machine can change how long it takes. The median of three times, so that one interrupt does not
/// count. What one thread loses, all lose, as in a row.
[[nodiscard]] double pulse_s(unsigned threads);

} // namespace tetrace::openmp
