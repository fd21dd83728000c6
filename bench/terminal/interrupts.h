#pragma once

namespace tetrace {

/// While one of these lives, and from something_to_keep() on, the first SIGINT or SIGTERM only asks the work to stop,
/// so that what it has so far is not lost; one that comes half a second later or more ends the process as usual.
/// Signals that are ignored stay ignored.
class StopWhenInterrupted {
public:
    StopWhenInterrupted();
    ~StopWhenInterrupted();
    StopWhenInterrupted(const StopWhenInterrupted&) = delete;
    StopWhenInterrupted& operator=(const StopWhenInterrupted&) = delete;
};

/// Says that the work has a part that is complete. Before, a signal ends the process at once.
void something_to_keep();

/// Whether a signal only asks the work to stop.
[[nodiscard]] bool is_stop_handled();

/// Whether the work has been asked to stop. Long work looks between its steps.
[[nodiscard]] bool is_interrupted();

/// As a signal would: if a child process has taken it, and in tests.
void interrupt();
/// Forgets an interrupt.
void forget_interrupt();

} // namespace tetrace
