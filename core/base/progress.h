#pragma once

#include <functional>
#include <string>

namespace tetrace {

/// Called by long work with its stage in a few words, the part of it that is done in [0, 1], or a negative number where
/// that is unknown (TetGen), and what the stage has reached, which may be empty. Called often; the receiver decides
/// what to show.
using Progress = std::function<void(const std::string& stage, double fraction, const std::string& detail)>;

} // namespace tetrace
