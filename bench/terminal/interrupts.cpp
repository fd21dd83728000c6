#include "bench/terminal/interrupts.h"

#include <atomic>
#include <csignal>
#include <cstring>
#include <ctime>
#include <unistd.h>

namespace tetrace {

namespace {

std::atomic<bool> interrupted{false};

constexpr int signals[] = {SIGINT, SIGTERM};
struct sigaction former[2]; ///< what the signals did, in their order
bool handled[2];
bool is_wanted = false;
constexpr double same_s = 0.5; // `timeout` and launchers signal a process and then its group
double first_s = 0;            ///< when the first signal came; 0: none has

void restore(int i)
{
    if (handled[i]) ::sigaction(signals[i], &former[i], nullptr);
    handled[i] = false;
}

/// Makes only async-signal-safe calls.
void ask_to_stop(int signal)
{
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    const double now_s = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    if (first_s > 0) {
        if (now_s - first_s < same_s) return;
        restore(0);
        restore(1);
        ::raise(signal);
        return;
    }
    first_s = now_s;
    constexpr char words[] = "\ntetrace: interrupted; finishing this step, to keep what is done. Again: end at once.\n";
    (void)!::write(STDERR_FILENO, words, sizeof words - 1);
    interrupted = true;
}

} // namespace

StopWhenInterrupted::StopWhenInterrupted()
{
    is_wanted = true;
}

StopWhenInterrupted::~StopWhenInterrupted()
{
    is_wanted = false;
    restore(0);
    restore(1);
}

void something_to_keep()
{
    static_assert(decltype(interrupted)::is_always_lock_free, "set by a signal handler");
    if (!is_wanted || interrupted || handled[0] || handled[1]) return;
    for (int i = 0; i < 2; ++i) {
        ::sigaction(signals[i], nullptr, &former[i]);
        handled[i] = former[i].sa_handler != SIG_IGN;
        struct sigaction ours {};
        ours.sa_handler = ask_to_stop;
        ours.sa_flags = SA_RESTART;
        if (handled[i]) ::sigaction(signals[i], &ours, nullptr);
    }
}

bool is_stop_handled()
{
    return handled[0] || handled[1];
}

bool is_interrupted()
{
    return interrupted;
}

void interrupt()
{
    interrupted = true;
}

void forget_interrupt()
{
    interrupted = false;
    first_s = 0;
}

} // namespace tetrace
