#pragma once

#include <functional>
#include <string>

namespace tetrace {

/// Told what long work is doing: a stage in a few words, and how much of it is done in [0, 1], or a negative number
/// where that cannot be known (TetGen). Called often; the receiver decides what a person sees of it.
using Progress = std::function<void(const std::string& stage, double fraction)>;

} // namespace tetrace
