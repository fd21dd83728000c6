#pragma once

#include "bench/options/options.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// The text without what tells whose machine it comes from: of each file name with an absolute path, of each path that
/// the options name, and of what lies below the home folder, only the last part stays; a home folder becomes "~".
[[nodiscard]] std::string anonymous_text(const std::string& text, const Options& options);

/// The result with anonymous_text() of all its texts, and without Google Benchmark's `context.host_name`.
[[nodiscard]] nlohmann::json anonymous_json(nlohmann::json result, const Options& options);

} // namespace tetrace
