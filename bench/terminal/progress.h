#pragma once

#include "core/base/progress.h"
#include "core/base/stopwatch.h"

#include <string>

namespace tetrace {

/// The progress line on a terminal's standard error: stage, elapsed time, and the percentage where it is known. Nothing
/// is drawn in the first 2 seconds. Without a terminal, such as in a log, it is a line of its own every 30 seconds.
class ProgressLine {
public:
    /// draws: whether there is a terminal to draw on. colour: whether escape sequences may be written. line_s: seconds
    /// between lines where nothing is drawn.
    ProgressLine(bool draws, bool colour, double line_s = 30);
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// fraction: done so far in [0, 1]; left_s: expected remaining seconds. Negative where unknown; then the rest of a
    /// stage whose fraction is known is expected to go on as its beginning did.
    /// detail: what the stage is working on; the time shown is the stage's.
    void show(const std::string& stage, double fraction, double left_s = -1, const std::string& detail = {});
    /// Clears the line. Called before anything else is written, and when the work is done.
    void clear();
    /// Shows what work tells.
    [[nodiscard]] Progress callback();

private:
    void draw(const std::string& what, double fraction, double left_s);

    bool draws_;
    bool colour_;
    double line_s_;
    std::size_t drawn_ = 0; ///< columns that the line takes up now
    bool has_drawn_ = false;
    std::string stage_, detail_;
    double first_fraction_ = 0; ///< of the stage
    Stopwatch in_stage_, since_draw_;
};

/// The line as show() draws it, at most `width` columns.
[[nodiscard]] std::string progress_text(const std::string& stage, double elapsed_s, double fraction, std::size_t width,
                                        double left_s = -1);

/// The program's progress line. Draws where standard error is a terminal that is not dumb, in colour unless NO_COLOR is
/// set. SIGINT and SIGTERM then clear the line before they end the program.
[[nodiscard]] ProgressLine& progress_line();

/// What SIGINT and SIGTERM write to standard error before they end the program: how to go on, in one line. Empty:
/// nothing.
void say_when_interrupted(const std::string& text);
/// That text, for an end that no signal handler makes.
[[nodiscard]] std::string words_when_interrupted();

/// Clears the progress line, then writes a message and a line end to standard error: printable_text(), which
/// may quote files and drivers.
void say(const std::string& message);

/// Clears the progress line, then writes a result to standard output. Throws Error{invalid_input} if writing fails.
void print(const std::string& text);

} // namespace tetrace
