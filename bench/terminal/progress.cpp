#include "bench/terminal/progress.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/base/printable.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

namespace tetrace {

namespace {

constexpr double quiet_s = 2.0;
constexpr double redraw_s = 0.1;
constexpr double rename_s = 0.005; // soon: a stage that takes minutes must not show the previous stage's name

bool draws_here()
{
    const char* term = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && term != nullptr && std::strcmp(term, "dumb") != 0;
}

/// Columns that the process's line takes up, for the signal handler.
std::atomic<std::size_t> columns_to_clear{0};

/// What the signal handler writes; its length is 0 while it is changed.
std::array<char, 4096> last_words;
std::atomic<std::size_t> last_words_length{0};

/// Clears the line and writes the last words, then lets the signal end the process as usual. Makes only
/// async-signal-safe calls.
void clear_and_end(int signal)
{
    char blanks[256];
    std::memset(blanks, ' ', sizeof blanks);
    blanks[0] = '\r';
    const std::size_t columns = std::min(columns_to_clear.load(), sizeof blanks - 2);
    blanks[columns + 1] = '\r';
    if (columns > 0) (void)!::write(STDERR_FILENO, blanks, columns + 2);
    if (const std::size_t length = last_words_length; length > 0)
        (void)!::write(STDERR_FILENO, last_words.data(), length);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

/// Does not touch signals that are ignored or that others handle.
void clear_when_interrupted()
{
    static_assert(decltype(columns_to_clear)::is_always_lock_free, "read by a signal handler");
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before {};
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL)
            std::signal(signal, clear_and_end);
    }
}

} // namespace

namespace {

ProgressLine make_progress_line()
{
    const bool draws = draws_here();
    if (draws) clear_when_interrupted();
    return ProgressLine(draws, !is_colour_refused());
}

} // namespace

std::string progress_text(const std::string& stage, double elapsed_s, double fraction, std::size_t width, double left_s)
{
    std::string text = fmt::format("{}  {}", stage, seconds_text(elapsed_s));
    if (fraction >= 0) text += fmt::format("  {:.0f} %", 100 * std::min(fraction, 1.0));
    if (left_s >= 0) text += fmt::format("  {} left", seconds_text(left_s));
    if (display_width(text) <= width) return text;
    std::size_t end = 0; // byte after the last character that fits
    for (std::size_t columns = 0; end < text.size(); ++end)
        if ((static_cast<unsigned char>(text[end]) & 0xC0) != 0x80 && ++columns > width) break;
    return text.substr(0, end);
}

ProgressLine::ProgressLine(bool draws, bool colour, double line_s) : draws_(draws), colour_(colour), line_s_(line_s) {}

void ProgressLine::show(const std::string& stage, double fraction, double left_s, const std::string& detail)
{
    if (stage != stage_) {
        stage_ = stage;
        in_stage_ = {};
        first_fraction_ = std::max(fraction, 0.0);
    }
    if (left_s < 0 && fraction > first_fraction_)
        left_s = in_stage_.seconds() * (1 - std::min(fraction, 1.0)) / (fraction - first_fraction_);
    const double drawing_s = !has_drawn_ ? quiet_s : detail != detail_ ? rename_s : redraw_s;
    if (since_draw_.seconds() < (draws_ ? drawing_s : line_s_)) return;
    detail_ = detail;
    draw(printable_line(detail.empty() ? stage : stage + ", " + detail), fraction, left_s);
    since_draw_ = {};
}

void ProgressLine::draw(const std::string& what, double fraction, double left_s)
{
    constexpr std::size_t log_width = 200;
    const std::size_t known = terminal_columns(STDERR_FILENO);
    const std::size_t width = !draws_ ? log_width : (known > 0 ? known : 80) - 1;
    const std::string text = progress_text(what, in_stage_.seconds(), fraction, width, left_s);
    if (!draws_) {
        std::fputs((text + "\n").c_str(), stderr);
        return;
    }
    const std::size_t columns = display_width(text);
    const std::string rest(drawn_ > columns ? drawn_ - columns : 0, ' ');
    std::fputs(fmt::format(fmt::runtime(colour_ ? "\r\x1b[2m{}\x1b[0m{}" : "\r{}{}"), text, rest).c_str(), stderr);
    std::fflush(stderr);
    drawn_ = columns;
    has_drawn_ = true;
    columns_to_clear = columns;
}

Progress ProgressLine::callback()
{
    return [this](const std::string& stage, double fraction, const std::string& detail) {
        show(stage, fraction, -1, detail);
    };
}

void ProgressLine::clear()
{
    if (drawn_ == 0) return;
    std::fputs(fmt::format("\r{}\r", std::string(drawn_, ' ')).c_str(), stderr);
    std::fflush(stderr);
    drawn_ = 0;
    columns_to_clear = 0;
    since_draw_ = {};
}

ProgressLine& progress_line()
{
    static ProgressLine line = make_progress_line();
    return line;
}

void say_when_interrupted(const std::string& text)
{
    last_words_length = 0;
    const std::string line = text.empty() ? text : printable_line(text) + "\n";
    if (line.size() > last_words.size()) return;
    std::ranges::copy(line, last_words.begin());
    last_words_length = line.size();
    if (!line.empty()) clear_when_interrupted();
}

std::string words_when_interrupted()
{
    const std::size_t length = last_words_length;
    return length == 0 ? std::string() : std::string(last_words.data(), length - 1);
}

void say(const std::string& message)
{
    progress_line().clear();
    std::fputs((printable_text(message) + "\n").c_str(), stderr);
}

void print(const std::string& text)
{
    progress_line().clear();
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("writing the result to standard output: {}; use --out FILE", std::strerror(errno)));
}

} // namespace tetrace
