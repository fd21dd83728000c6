#pragma once

#include "core/base/progress.h"
#include "core/base/stopwatch.h"

#include <string>

namespace tetrace {

/// The one line on a terminal's standard error that tells what long work is doing: stage, elapsed time, percentage
/// where it is known. Nothing is drawn without a terminal, nor in the first 2 seconds.
class ProgressLine {
public:
    /// draws: whether to draw at all. colour: whether escape sequences may be written.
    ProgressLine(bool draws, bool colour);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// fraction: done so far in [0, 1]; left_s: seconds that it will still take. Negative where it cannot be known.
    /// detail: what the stage is working on; the time that is shown is the stage's.
    void show(const std::string& stage, double fraction, double left_s = -1, const std::string& detail = {});
    /// Takes the line away, before anything else is written, and when the work is done.
    void clear();
    [[nodiscard]] Progress callback();

private:
    bool draws_;
    bool colour_;
    std::size_t drawn_ = 0; ///< columns that the line takes now
    bool has_drawn_ = false;
    std::string stage_, detail_;
    Stopwatch in_stage_, since_draw_;
};

/// The line as show() draws it, at most `width` columns.
[[nodiscard]] std::string progress_text(const std::string& stage, double elapsed_s, double fraction, std::size_t width,
                                        double left_s = -1);

/// The program's one line: draws where standard error is a terminal that is not dumb, in colour unless NO_COLOR is set.
/// SIGINT and SIGTERM then take the line away before they end the program.
[[nodiscard]] ProgressLine& progress_line();

/// Writes a message and a line end to standard error, the progress line out of the way.
void say(const std::string& message);

/// Writes a result to standard output, the progress line out of the way. Throws Error{invalid_input} where it cannot.
void print(const std::string& text);

} // namespace tetrace
