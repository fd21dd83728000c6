#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tetrace {

// Text from outside (a file's name, a mesh, a driver) as any terminal, JSON, XML and CSV can have it: UTF-8 without
// control characters. Applied where such text enters, so that later code can rely on it.

/// The text with a '?' for each byte that is of no UTF-8 character, and for each character that does something instead
/// of being shown: controls (U+0000 to U+001F, U+007F to U+009F) other than tab and line end, separators of lines and
/// paragraphs, changes of the writing's direction (U+202A to U+202E, U+2066 to U+2069), and what is not a character at
/// all.
[[nodiscard]] std::string printable_text(std::string_view text);

/// The same of a name: of one line, so that tabs and line ends become '?' too.
[[nodiscard]] std::string printable_line(std::string_view name);

} // namespace tetrace
