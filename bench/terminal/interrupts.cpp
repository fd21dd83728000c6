#include "bench/terminal/interrupts.h"

#include <atomic>
#include <csignal>
#include <cstring>
#include <unistd.h>

namespace tetrace {

namespace {

std::atomic<bool> interrupted{false};

constexpr int signals[] = {SIGINT, SIGTERM};
struct sigaction former[2]; ///< what the signals did, in their order
bool handled[2];
bool is_wanted = false;

void restore(int i)
{
    if (handled[i]) ::sigaction(signals[i], &former[i], nullptr);
    handled[i] = false;
}

/// Makes only async-signal-safe calls.
void ask_to_stop(int)
{
    constexpr char words[] = "\ntetrace: interrupted; finishing this step, to keep what is done. Again: end at once.\n";
    (void)!::write(STDERR_FILENO, words, sizeof words - 1);
    interrupted = true;
    restore(0);
    restore(1);
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
}

} // namespace tetrace
