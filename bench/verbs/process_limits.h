#pragma once

namespace tetrace {

/// Throws Error{usage} if OMP_STACKSIZE or `ulimit -s` leaves OpenMP's threads too small a stack: libgomp ends the
/// process without a word of ours, or it crashes.
void check_stacks();

/// Keeps this process and those that it starts to the CPU quota of its control groups (a container's), unless
/// OMP_NUM_THREADS decides. Call it before any backend lists its devices.
void limit_threads();

} // namespace tetrace
