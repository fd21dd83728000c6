#pragma once

#include <string>

namespace tetrace {

// Scripts for a shell that complete verbs, each verb's options, the values that options accept by name, and files.
[[nodiscard]] std::string bash_completion();
[[nodiscard]] std::string zsh_completion();
[[nodiscard]] std::string fish_completion();

} // namespace tetrace
