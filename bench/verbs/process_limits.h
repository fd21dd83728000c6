#pragma once

namespace tetrace {

/// Throws Error{usage} if OMP_STACKSIZE or `ulimit -s` leaves OpenMP's threads too small a stack: libgomp ends the
/// process without a word of ours, or it crashes.
void check_stacks();

} // namespace tetrace
