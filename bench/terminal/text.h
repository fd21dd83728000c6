#pragma once

#include <cstdint>
#include <string>

namespace tetrace {

/// Columns that a UTF-8 text takes up on a terminal; each character counts as one.
[[nodiscard]] std::size_t display_width(const std::string& text);

/// Paragraphs (separated by empty lines) filled to `width` columns, each line indented; ends in a newline.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);
/// The same, but no paragraph ends in a line of one short word.
[[nodiscard]] std::string wrapped_without_orphans(const std::string& text, std::size_t width, std::size_t indent);

/// A whole number with commas between thousands: 209,397.
[[nodiscard]] std::string with_commas(std::uint64_t value);

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

} // namespace tetrace
