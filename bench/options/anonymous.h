#pragma once

#include "bench/options/options.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// The text without anything that identifies the machine. Three kinds of path keep only their last part: file names
/// with an absolute path, paths that the options name, and paths below the home folder. A home folder becomes "~".
[[nodiscard]] std::string anonymous_text(const std::string& text, const Options& options);

/// The result with anonymous_text() applied to all its texts.
[[nodiscard]] nlohmann::json anonymous_json(nlohmann::json result, const Options& options);

} // namespace tetrace
