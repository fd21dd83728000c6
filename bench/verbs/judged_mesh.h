#pragma once

#include "bench/options/options.h"
#include "scenes/load.h"

namespace tetrace {

/// Throws Error{usage} unless the options name one mesh. option: that names it, with its value.
void require_one_mesh(const Options& options, const char* option);

/// Reads the mesh of `rays` or `judge`, and prints what its reader says. Throws as read_mesh_of() does, and
/// Error{invalid_input} naming the first vertex with a coordinate that the exact search cannot take.
[[nodiscard]] ReadMesh read_judged_mesh(const Options& options);

} // namespace tetrace
