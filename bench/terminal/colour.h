#pragma once

#include <cstddef>
#include <string>

namespace tetrace {

/// A word of a table in the colour of what it means: red where it is wrong or failed, yellow where it is doubtful,
/// green where it is faster; any other text as it is. The colour adds nothing to the word. words: begins with a status,
/// a conformity, or a verdict of `compare`.
[[nodiscard]] std::string in_colour(const std::string& words);

/// The text as a file gets it, without colours.
[[nodiscard]] std::string without_colour(const std::string& text);

/// Whether NO_COLOR asks for no colour at all (https://no-color.org).
[[nodiscard]] bool is_colour_refused();

/// Whether what is written to the file (STDOUT_FILENO, STDERR_FILENO) is in colour: it is a terminal that has colours,
/// and NO_COLOR does not ask otherwise.
[[nodiscard]] bool has_colour(int file);

/// How many columns the terminal of a file has: $COLUMNS, else what the terminal reports, else 80. 0 if there is no
/// terminal.
[[nodiscard]] std::size_t terminal_columns(int file);

} // namespace tetrace
