#pragma once

#include "core/mesh/scene.h"

#include <span>
#include <vector>

namespace tetrace {

/// What the information section of a `.tet` file holds: name, the domain's kind and divisions, and how it was made.
[[nodiscard]] std::vector<char> pack_information(const Scene& scene);

/// Reads it back. False if the bytes are something else.
[[nodiscard]] bool unpack_information(std::span<const char> bytes, Scene& scene);

} // namespace tetrace
