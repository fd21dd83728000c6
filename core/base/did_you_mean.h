#pragma once

#include <string>
#include <vector>

namespace tetrace {

/// "; did you mean --samples?": the name that one or two slips of the hand turn into the text. Empty if none is so
/// near, or if several are equally near.
[[nodiscard]] std::string did_you_mean(const std::string& text, const std::vector<std::string>& names);

} // namespace tetrace
