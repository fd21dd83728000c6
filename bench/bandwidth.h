#pragma once

namespace tetrace {

/// Copy bandwidth of the host's memory: bytes read and written per second, the best of a few copies of 128 MiB by so
/// many threads. What the processor writes without saying (read for ownership) is not counted, as in STREAM.
/// Source: McCalpin, STREAM (1995), kernel Copy.
[[nodiscard]] double copy_bandwidth(unsigned threads);

} // namespace tetrace
