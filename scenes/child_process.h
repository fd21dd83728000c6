#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tetrace {

struct ChildLimits {
    double time_s = 0;              ///< wall clock; 0 is none
    double processor_s = 0;         ///< processor time of all its threads together; 0 is none
    std::uint64_t memory_bytes = 0; ///< address space (RLIMIT_AS); 0 is none
    double finish_s = 0;            ///< what a child gets to finish its work after SIGINT; 0: it is ended at once
    std::uint64_t file_bytes = 0;   ///< of the longest file that it may write (RLIMIT_FSIZE); 0 is none
};

/// How a child ended.
struct ChildOutcome {
    enum class End { exited, signalled, timed_out, interrupted } end = End::exited;
    int code = 0; ///< exit status, or the signal's number
    double wall_s = 0;
    double processor_s = 0;   ///< that it used
    std::string out;          ///< captured standard output, its last 64 KiB
    std::string errors;       ///< captured standard error, its last 64 KiB
    bool interrupted = false; ///< an interrupt came; with End::exited the child finished its work after it
};

/// Runs a program and waits for it, killing it past its limits. SIGINT and SIGTERM sent to this process end the child
/// too (End::interrupted); with finish_s the first of them is passed on as SIGINT, and the second ends the child. The
/// child dies with its parent, however the parent ends. It has an empty standard input, pipes for its output, and no
/// other open file; no program that it starts gains privileges, and it leaves no core. on_error_line: each whole line
/// of the child's standard error as it comes; on_tick: about ten times per second, with the
/// processor time that it has used. Throws Error{missing} if the
/// program cannot be started.
[[nodiscard]] ChildOutcome run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                     const ChildLimits& limits,
                                     const std::function<void(const std::string&)>& on_error_line = {},
                                     const std::function<void(double processor_s)>& on_tick = {});

} // namespace tetrace
