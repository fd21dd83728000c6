#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace tetrace {

/// The text of a result file: what an array or an object holds is filled into lines of up to 120 characters, as far as
/// it fits; what is longer begins a line of its own, and its contents are indented by one more blank. It ends in a line
/// break. Reading it gives the same value, but for texts that are not UTF-8, in which U+FFFD takes the place of each
/// bad byte, so that no result is lost because of a path. A number a line, as other writers have it, takes twice the
/// bytes for results with many samples or points.
[[nodiscard]] std::string result_text(const nlohmann::json& value);

} // namespace tetrace
