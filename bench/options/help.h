#pragma once

#include <string>

namespace tetrace {

/// What `tetrace help TOPIC` prints: the program (empty topic), a verb, or "options", the Markdown table of all
/// options.
[[nodiscard]] std::string help_text(const std::string& topic);

/// The program's version, commit, compiler and licence.
[[nodiscard]] std::string version_text();

} // namespace tetrace
