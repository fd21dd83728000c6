#pragma once

#include <string>
#include <vector>

namespace tetrace {

/// Throws Error{usage} if OMP_STACKSIZE or `ulimit -s` leaves OpenMP's threads too small a stack: libgomp ends the
/// process without a word of ours, or it crashes.
void check_stacks();

/// Keeps this process and those that it starts to the CPU quota of its control groups (a container's), unless
/// OMP_NUM_THREADS decides. Call it before any backend lists its devices.
void limit_threads();

/// If other processes use the processors, starts this program again with arguments, now with OpenMP's threads that
/// sleep after some 50 us of waiting; libgomp's spin for milliseconds, while the thread that they wait for has no
/// processor. Returns if nobody else works, if GOMP_SPINCOUNT or OMP_WAIT_POLICY is set, or if it cannot.
void start_again_if_busy(const std::vector<std::string>& arguments);

} // namespace tetrace
