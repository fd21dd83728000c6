#pragma once

#include <cstdint>
#include <string>

namespace tetrace {

/// Columns that a UTF-8 text takes on a terminal, every character counted as one.
[[nodiscard]] std::size_t display_width(const std::string& text);

/// Paragraphs (separated by empty lines) filled to `width` columns, each line indented; ends in a newline.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);
/// The same, and no paragraph ends in a line of one short word.
[[nodiscard]] std::string wrapped_without_orphans(const std::string& text, std::size_t width, std::size_t indent);

/// A whole number with commas between thousands: 209,397.
[[nodiscard]] std::string with_commas(std::uint64_t value);

/// A size in MB (10^6 bytes) with one decimal, or kB below 100 kB.
[[nodiscard]] std::string size_text(std::uint64_t bytes);

/// Seconds as a person reads them: "0.8 s", "12 s", "3 min 05 s".
[[nodiscard]] std::string seconds_text(double seconds);

/// A text as XML and HTML show it, in attributes too: the five characters replaced, and what XML cannot hold (control
/// characters, bytes that are no UTF-8) by question marks.
[[nodiscard]] std::string xml_text(const std::string& text);

} // namespace tetrace
