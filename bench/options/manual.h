#pragma once

#include <string>

namespace tetrace {

/// A manual page of section 1, for man: the program, its verbs, and all options, as help has them.
[[nodiscard]] std::string man_page();

/// Functions for a shell that complete verbs, each verb's options, and files.
[[nodiscard]] std::string bash_completion();
[[nodiscard]] std::string zsh_completion();

} // namespace tetrace
