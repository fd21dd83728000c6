#pragma once

#include <string>

namespace tetrace {

/// A manual page of section 1, for man: the program, its verbs, and all options, as help has them.
[[nodiscard]] std::string man_page();

} // namespace tetrace
