#pragma once

#include <csignal>
#include <cstdlib>
#include <string>
#include <unistd.h>

namespace tetrace::test {

/// How a call of a driver is to go wrong, as an environment variable says it: "<call> <how>", or "<call>:<n> <how>" for
/// the n-th call of its kind. Empty: not at all.
inline std::string fault_at(const char* variable, const std::string& call, int number)
{
    const char* const asked = std::getenv(variable);
    if (asked == nullptr) return {};
    const std::string text = asked;
    for (const std::string& name : {call + " ", call + ":" + std::to_string(number) + " "})
        if (text.rfind(name, 0) == 0) return text.substr(name.size());
    return {};
}

/// Does what ends a process, or keeps it for ever; gives back what the call itself has to do.
inline std::string misbehave(const std::string& how)
{
    if (how == "abort") std::abort();
    if (how == "segv") std::signal(SIGSEGV, SIG_DFL), std::raise(SIGSEGV); // PoCL catches it
    if (how == "kill") std::raise(SIGKILL);
    if (how == "exit") ::_exit(7);
    while (how == "hang")
        ::pause();
    return how;
}

} // namespace tetrace::test
