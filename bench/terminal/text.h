#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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

/// Columns that a UTF-8 text takes up on a terminal; each character counts as one.
[[nodiscard]] std::size_t display_width(const std::string& text);

/// Paragraphs (separated by empty lines) filled to `width` columns, each line indented; ends in a newline.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);
/// The same, but no paragraph ends in a line of one short word.
[[nodiscard]] std::string wrapped_without_orphans(const std::string& text, std::size_t width, std::size_t indent);

/// A whole number with commas between thousands: 209,397.
[[nodiscard]] std::string with_commas(std::uint64_t value);

/// "1 row", "1234 rows".
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view one, std::string_view many);

/// Adds to an enumeration, with the separator unless the item is its first.
void append_item(std::string& text, std::string_view separator, std::string_view item);

/// A size in MB (10^6 bytes) with one decimal, or kB below 100 kB.
[[nodiscard]] std::string size_text(std::uint64_t bytes);

/// A share from 0 to 1 in whole percent: "45 %". "<1 %" and ">99 %" are what is not quite none, or all.
[[nodiscard]] std::string percent_text(double share);

/// Seconds in a readable form: "0.8 s", "12 s", "3 min 05 s".
[[nodiscard]] std::string seconds_text(double seconds);

/// Text escaped for XML and HTML, attributes included. The five special characters are escaped; question marks replace
/// what XML cannot hold and more, see printable_text().
[[nodiscard]] std::string xml_text(const std::string& text);

/// A word of a command line: in single quotes where a shell would not take it as one word.
[[nodiscard]] std::string shell_word(const std::string& word);

/// A command line of tetrace's with these arguments, as a shell takes it.
[[nodiscard]] std::string command_of(const std::vector<std::string>& arguments);

} // namespace tetrace
